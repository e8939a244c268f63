"""Outputs: inputs that are named as outputs, links, devices, discs that are full, names that are patterns."""
import os
import shutil

from row import Row, both, file


def links(folder):
    os.symlink("scan.mha", folder / "link.mha")
    os.link(folder / "scan.mha", folder / "hard.mha")
    os.symlink("beads.csv", folder / "link.csv")
    (folder / "sub").mkdir()


def detached(folder):
    data = (folder / "scan.mha").read_bytes()
    at = data.index(b"ElementDataFile = LOCAL\n") + len(b"ElementDataFile = LOCAL\n")
    (folder / "v.mhd").write_bytes(data[:at].replace(b"LOCAL", b"v.raw"))
    (folder / "v.raw").write_bytes(data[at:])


def inputs():
    for name, command in {
            "segment -o the scan": "segment scan.mha -o scan.mha",
            "segment -o a link to the scan": "segment scan.mha -o link.mha",
            "segment -o a hard link": "segment scan.mha -o hard.mha",
            "segment of a link -o the scan": "segment link.mha -o scan.mha",
            "segment -o another name of it": "segment scan.mha -o sub/../scan.mha",
            "segment --labels the scan": "segment scan.mha -o new.csv --labels scan.mha",
            "segment --labels a link": "segment scan.mha -o new.csv --labels link.mha",
            "segment --bridges the scan": "segment scan.mha -o new.csv --bridges scan.mha",
            "segment --bridges as -o": "segment scan.mha -o new.csv --bridges new.csv",
            "segment --bridges as a link to -o": "segment scan.mha -o beads.csv --bridges link.csv",
            "segment -o in .json": "segment scan.mha -o new.json",
            "segment --labels as --bridges": "segment scan.mha -o new.csv --labels new.mha --bridges new.mha",
            "segment --bridges as the summary": "segment scan.mha -o new.csv --bridges new.json",
            "segment .mhd -o its data": "segment v.mhd -o v.raw",
            "segment .mhd --labels over its data": "segment v.mhd -o new.csv --bridges v.raw",
            "convert onto itself": "convert p.vtp p.vtp",
            "convert onto a link": "convert beads.csv link.csv",
            "convert --bridges onto the output": "convert p.vtp new.csv --bridges new.csv",
            "convert --bridges onto the input": "convert p.vtp new.csv --bridges p.vtp",
            "track -o before": "track beads.csv link.csv -o beads.csv",
            "track -o in .json": "track beads.csv beads.csv -o new.json",
            "modulus -o the packing": "modulus p.vtp --sample s.toml -o p.vtp",
            "modulus -o the sample": "modulus p.vtp --sample s.toml -o s.toml",
            "bridge -o the sample": "bridge s.toml -o s.toml",
            "bridge --plot as -o": "bridge s.toml --d-um 50,60 -o new.png --plot new.png",
            "phantom --truth over --packing": "phantom s.toml -o new.mha --packing truth.vtp --truth truth.vtp"}.items():
        yield Row("1 " + name, "$P " + command + " --quiet", 2, "", both(links, detached))
    yield Row("1 pack -o beside its bridges", "$P pack beads.csv --sample s.toml --bridges q.json -o q.vtp", 2, "q.json",
              lambda folder: shutil.copy(folder / "bridges.csv", folder / "q.json"))
    for command in ("segment scan.mha -o", "pack beads.csv --sample s.toml -o", "track beads.csv beads.csv -o", "bridge s.toml -o"):
        output = "circle/new.vtp" if command.startswith("pack") else "circle/new.csv"
        yield Row(f"1 {command} below a link in a circle", f"$P {command} {output} --quiet", 3, "cannot be seen",
                  lambda folder: os.symlink("circle", folder / "circle"), warns=True)
    for number in (1, 2):
        yield Row(f"1 segment slices -o slice {number}", f"$P segment slices --voxel-um 10 -o slices/s{number}.png", 2, f"s{number}.png",
                  lambda folder: [file(f"slices/s{k}.png", PNG)(folder) for k in (1, 2, 3)])
    yield Row("1 compress where its packing is a frame", "$P compress out/frames/frame_0001.vtp --sample s.toml -o out", 2, "frame_0001.vtp",
              lambda folder: [(folder / "out/frames").mkdir(parents=True), shutil.copy(folder / "p.vtp", folder / "out/frames/frame_0001.vtp")])


PNG = bytes.fromhex("89504e470d0a1a0a0000000d49484452000000020000000208000000005a5a5a5a0000000049454e44ae426082")


def away(name, inner):
    """A folder whose inner one is a link to elsewhere, where a file of such a name lies."""

    def prepare(folder):
        (folder / "elsewhere").mkdir()
        (folder / "elsewhere" / "frame_0000.vtp").write_text("not yours")
        (folder / "elsewhere" / "frame_0000.png").write_text("not yours")
        (folder / name).mkdir(exist_ok=True)
        target = folder / name / inner
        if target.exists():
            shutil.rmtree(target)
        os.symlink(os.path.abspath(folder / "elsewhere"), target)

    return prepare


def folders():
    yield Row("10 frames is a link", "$P compress p.vtp --sample s.toml -o out --quiet", 3, "frames", away("out", "frames"))
    yield Row("10 frames is a link, resumed", "$P compress p.vtp --sample s.toml -o out --quiet --resume", 3, "frames", away("out", "frames"))
    yield Row("10 a realisation is a link", "$P compress p.vtp --sample s.toml -o out --realisations 2 --quiet", 3, "realisation_01",
              away("out", "realisation_01"))
    yield Row("10 the film's folder is a link", "$P render run --view displacement -o out --quiet", 3, "film", away("out", "film"), changes=("out/*",))
    yield Row("10 pictures is a link", "$P render run --quiet", 3, "pictures", away("run", "pictures"))
    for inner in ("runs", "packings", "logs"):
        yield Row(f"10 a store's {inner} is a link", "$P sweep sweep.toml -o out --quiet", 3, inner,
                  both(lambda folder: (folder / "out").mkdir(), away("out/store", inner)), changes=("out/store/*",))
    yield Row("10 a run folder that is a link is the user's", "$P compress p.vtp --sample s.toml -o out --quiet", 0, "",
              lambda folder: [(folder / "there").mkdir(), os.symlink("there", folder / "out")], changes=("there/*",))


def streams():
    for sink in ("/dev/full", "&-"):
        yield Row(f"11 the table to {sink}", f"$P bridge --d-um 70 >{sink}", 4, "standard output")
        yield Row(f"11 Table 1 to {sink}", f"$P bridge >{sink}", 4, "standard output")
        yield Row(f"11 the help to {sink}", f"$P --help >{sink}", 4, "standard output")
    for device in ("/dev/full", "/dev/null", "/proc/self/fd/1"):  # by links: a program that fails here must not replace them
        link = lambda folder, device=device: os.symlink(device, folder / "sink.csv")
        yield Row(f"11 -o a link to {device}", "$P bridge --d-um 70 -o sink.csv", 3, "sink.csv", link)
        yield Row(f"11 convert to a link to {device}", "$P convert p.vtp sink.csv", 3, "sink.csv", link)
    yield Row("11 a pipe as output", "mkfifo f; $P bridge --d-um 70 -o f", 3, "f", changes=("f",))
    drawn = lambda folder: (folder / "out/film.mp4").stat().st_size > 1000 and (folder / "out/report.html").exists()
    yield Row("11 render without standard streams", "$P render run --view displacement -o out <&- >&- 2>&-", 0, "", changes=("out", "out/*"), then=drawn)
    yield Row("11 render with standard error full", "$P render run --view displacement -o out 2>/dev/full", 0, "", changes=("out", "out/*"), then=drawn)
    for command in ("segment scan.mha -o new.csv --bridges g.csv", "pack beads.csv --sample s.toml -o new.vtp"):
        yield Row(f"11 {command.split()[0]} without standard streams", f"$P {command} <&- >&- 2>&-", 0, "",
                  changes=("new.*", "g.csv"), then=lambda folder: any(folder.glob("new.*")))


def names():
    film = lambda name: lambda folder: (folder / name / "film.mp4").stat().st_size > 1000
    for name in ("a%d%04d%s%n", "pipe:a:b", "-a b'c\"dä€"):  # patterns, protocols, options and quotes of other programs
        quoted = "'" + name.replace("'", "'\\''") + "'"
        yield Row(f"14 render -o {name}", f"$P render run --view displacement --quiet --out={quoted}", 0, "", changes=(name.replace("[", "?"), name + "/*"),
                  then=film(name))
        yield Row(f"14 phantom -o {name}.mha", f"$P phantom s.toml --quiet --out={quoted[:-1]}.mha'", 0, "", changes=(name + ".mha",),
                  then=lambda folder, name=name: (folder / (name + ".mha")).stat().st_size > 10_000)
        yield Row(f"14 pack -o {name}.vtp", f"$P pack beads.csv --sample s.toml --quiet --out={quoted[:-1]}.vtp'", 0, "",
                  changes=(name + ".vtp", name + ".json"))


def no_names():
    """What is empty would pass for what was not given, or take the next word in its place."""
    for command in ("segment scan.mha", "pack beads.csv --sample s.toml", "compress p.vtp --sample s.toml", "render run", "sweep sweep.toml",
                    "phantom s.toml", "modulus p.vtp --sample s.toml", "track beads.csv beads.csv", "bridge s.toml", "diagnose e.toml",
                    "blind make split.toml", "blind diagnose split", "blind score split reports", "reproduce paper", "demo",
                    "pipette frames --calibration c.toml"):
        for words in ("-o ''", "--out ''", "--out=", "--out= --quiet"):
            yield Row(f"14 {command.split(' --')[0]} {words}", f"$P {command} {words}", 2, "found nothing, expected")
    for command in ("convert p.vtp ''", "convert '' new.vtp", "segment ''", "segment scan.mha -o new.csv --bridges ''",
                    "segment scan.mha -o new.csv --labels ''", "segment scan.mha -o new.csv --qa ''", "phantom s.toml -o new.mha --truth ''",
                    "phantom s.toml -o new.mha --packing ''", "pack beads.csv --sample s.toml -o new.vtp --bridges ''",
                    "track beads.csv beads.csv -o new.csv --pictures ''", "sweep sweep.toml -o new --store ''", "''", "bridge s.toml --plot ''"):
        yield Row(f"14 {command}", f"$P {command}", 2, "found nothing, expected")


def full_discs():
    limit = "ulimit -f {}; trap '' XFSZ; "
    yield Row("16 full disc in --labels", limit.format(300) + "$P segment scan.mha -o new.csv --labels new.mha --quiet", 4, "new.mha")
    yield Row("16 full disc in --labels over older files", limit.format(300) + "$P segment scan.mha -o beads.csv --labels new.mha --quiet", 4, "new.mha")
    yield Row("16 full disc in phantom", limit.format(300) + "$P phantom s.toml -o new.mha --truth new.vtp --quiet", 4, "new.mha")
    yield Row("16 full disc in a TIFF", limit.format(300) + "$P segment scan.mha -o new.csv --labels new.tif --quiet", 4, "new.tif")
    yield Row("16 full disc in convert", limit.format(1) + "$P convert p.vtp new.csv --bridges new_bridges.csv --quiet", 4, "new")
    yield Row("16 full disc in a packing", limit.format(1) + "$P pack beads.csv --sample s.toml -o new.vtp --quiet", 4, "new")
    yield Row("16 full disc in a picture", limit.format(4) + "$P bridge s.toml --d-um 50,60 -o new.csv --plot new.png --quiet", 4)


def numbers():
    def finite(folder):
        tables = [path.read_text() for path in (folder / "run").glob("*.csv")] + [path.read_text() for path in folder.glob("swept/**/*.csv")]
        cells = [cell for text in tables for line in text.splitlines() if not line.startswith("#") for cell in line.split(",")]
        return len(cells) > 100 and not {"inf", "-inf", "nan", "-nan"} & set(cells)

    yield Row("19 no table holds inf or nan", "true", 0, then=finite)


def rows():
    yield from inputs()
    yield from folders()
    yield from streams()
    yield from names()
    yield from no_names()
    yield from full_discs()
    yield from numbers()
