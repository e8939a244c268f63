"""What commands are given: files of the wrong kind, cut files, keys and options out of their range, odd names, streams,
environments and places to write."""
import os
import re
import shutil

from row import LEFT_OUT, SAMPLE, Row, both, file

PNG = bytes.fromhex("89504e470d0a1a0a0000000d49484452000000020000000208000000005a5a5a5a0000000049454e44ae426082")
SPLIT = '[split]\nname = "t"\nseed = 5\ncases = 1\nsample = "m.toml"\n[test]\nmax_strain = 0.02\nunload_at = 0.01\n' \
        'sigma_centre_um = 0.3\nsigma_diameter_um = 0.3\n[strata]\nnone = 1\n[[packing]]\nseed = 301\nheight_um = 900\n' \
        'short_height_um = 700\nshort_youngs_modulus_pa = 4.5e6\n'
EXPERIMENT = '[experiment]\nname = "t"\nsample = "s.toml"\n[uncertainty]\n"contact.friction" = 0.1\n' \
             '[[observation]]\nkind = "coordination"\nfile = "z.csv"\n'
CALIBRATION = '[camera]\num_per_pixel = 1.37\num_per_pixel_sigma = 0.01\nframe_rate_hz = 10\n[pipette]\n' \
              'stiffness_n_per_m = 40\nstiffness_sigma_n_per_m = 2\n[stage]\nspeed_um_s = 5\n[test]\ndirection = "normal"\n'

plans = both(file("m.toml", SAMPLE.replace('"drawn"', '"measured"')), file("split.toml", SPLIT), file("e.toml", EXPERIMENT),
             file("z.csv", "z,z_sigma\n7,0.1\n"), file("c.toml", CALIBRATION))

# What each takes, and the file that is to be another; {} is its name.
ARGUMENTS = {
    "segment": "segment {} -o new.csv", "segment --beads": "segment scan.mha -o new.csv --beads {}", "pack": "pack {} --sample s.toml -o new.vtp",
    "pack --bridges": "pack beads.csv --bridges {} --sample s.toml -o new.vtp", "pack --sample": "pack beads.csv --sample {} -o new.vtp",
    "compress": "compress {} --sample s.toml -o new", "compress --sample": "compress p.vtp --sample {} -o new",
    "phantom": "phantom {} -o new.mha", "phantom --packing": "phantom s.toml --packing {} -o new.mha", "modulus": "modulus {} --sample s.toml -o new.json",
    "bridge": "bridge {} -o new.csv", "convert": "convert {} new.csv --from vtp", "convert --from csv": "convert {} new.vtp --from csv",
    "convert --from lammps": "convert {} new.csv --from lammps", "convert --from yade": "convert {} new.csv --from yade",
    "track": "track {} beads.csv -o new.csv", "track after": "track beads.csv {} -o new.csv", "render": "render {} -o new",
    "sweep": "sweep {} -o new", "diagnose": "diagnose {} -o new", "diagnose --plan": "diagnose {} --plan --dry-run -o new",
    "blind make": "blind make {} -o new", "blind score": "blind score {} {} -o new", "blind diagnose": "blind diagnose {} -o new",
    "reproduce": "reproduce {} -o new", "pipette": "pipette {} --calibration c.toml -o new.csv",
}


def wrong_kinds():
    def prepare(folder):
        plans(folder)
        (folder / "x_png").write_bytes(PNG)
        (folder / "x_empty").write_bytes(b"")
        (folder / "x_zeros").write_bytes(bytes(5000))
        (folder / "x_folder").mkdir()
        shutil.copy(folder / "scan.mha", folder / "x_scan")
        shutil.copy(folder / "p.vtp", folder / "x_packing")
        os.mkfifo(folder / "x_pipe")
        os.symlink("x_loop", folder / "x_loop")
        os.symlink("absent", folder / "x_dangling")

    for name, command in ARGUMENTS.items():
        for kind in ("png", "empty", "zeros", "folder", "scan", "packing", "pipe", "loop", "dangling", "absent"):
            if kind == "packing" and ("vtp" in command.split("{}")[1] and "--from" in command or name in
                                      ("compress", "modulus", "phantom --packing")):
                continue
            if (kind, name) == ("empty", "convert --from yade"):
                continue  # a list of no beads
            yield Row(f"kind: {name} given {kind}", f"$P {command.replace('{}', 'x_' + kind)} --quiet", (2, 3), "", prepare)


def cuts():
    """Files cut at each eighth. A table that is cut between two lines is a shorter table."""
    commands = {"scan.mha": "segment scan.mha -o new.csv", "p.vtp": "compress p.vtp --sample s.toml -o new",
                "run/checkpoint": "compress p.vtp --sample s.toml -o run --resume",
                "run/result.json": "render run -o new --no-film", "swept/store/index.sqlite": "sweep sweep.toml -o swept"}
    for name, command in commands.items():
        for eighth in range(8):
            status = (0, 3) if "index" in name else 3  # an empty index is a new one
            yield Row(f"cut: {name} at {eighth}/8", f"$P {command} --quiet", status, "", cut(name, eighth),
                      changes=("swept/store/index.sqlite*",), warns=True)
    tables = {"beads.csv": "pack beads.csv --sample s.toml -o new.vtp", "bridges.csv": "pack beads.csv --bridges bridges.csv --sample s.toml -o new.vtp",
              "run/curve.csv": "render run -o new --no-film", "s.toml": "phantom s.toml -o new.mha", "sweep.toml": "sweep sweep.toml -o new --dry-run",
              "split.toml": "blind make split.toml -o new --dry-run", "e.toml": "diagnose e.toml -o new --dry-run"}
    for name, command in tables.items():
        for eighth in range(8):
            yield Row(f"cut: {name} at {eighth}/8", f"$P {command} --quiet", (0, 3), "", both(plans, cut(name, eighth)),
                      changes=("new*",), warns=True)


def cut(name, eighth):
    def prepare(folder):
        data = (folder / name).read_bytes()
        (folder / name).write_bytes(data[:len(data) * eighth // 8])

    return prepare


VALUES = ("0", "-1", "1e300", "nan", "9223372036854775808", "true", '"x"', "[1, 2]", "")


def keys():
    files = {"s.toml": (SAMPLE, "pack --generate --sample s.toml -o new.vtp"),
             "sweep.toml": ('[sweep]\nname = "test"\nsample = "s.toml"\nrealisations = 2\nseed = 1\npacking_seed = 3\nkeep = "all"\n',
                            "sweep sweep.toml -o new --dry-run"),
             "split.toml": (SPLIT, "blind make split.toml -o new --dry-run"), "e.toml": (EXPERIMENT, "diagnose e.toml -o new --dry-run"),
             "c.toml": (CALIBRATION, "pipette frames --calibration c.toml -o new.csv")}
    for name, (text, command) in files.items():
        for line in text.splitlines():
            key = line.split(" = ")[0]
            if " = " not in line:
                continue
            for value in VALUES:
                status = 3 if value in ("nan", "9223372036854775808", "") else (0, 3)
                yield Row(f"key: {name}: {key} = {value}", f"$P {command} --quiet", status, "",
                          both(plans, frames, file(name, text.replace(line, f"{key} = {value}", 1))), changes=("new*",), warns=True)


def frames(folder):
    (folder / "frames").mkdir()
    for k in (1, 2, 3):
        (folder / f"frames/f{k}.png").write_bytes(PNG)


def options():
    numbers = {"segment scan.mha -o new.csv": ("--voxel-um", "--cutoff", "--false-discoveries", "--min-diameter-um", "--size", "--threads"),
               "compress p.vtp --sample s.toml -o new": ("--realisations", "--threads", "--seed"),
               "bridge --d-um 70": ("--D-um", "--gap-um", "--E-pa", "--nu", "--D2-um"), "bridge --gap-um 2": ("--d-um",),
               "modulus p.vtp --sample s.toml -o new.json": ("--strain",), "track beads.csv beads.csv -o new.csv": ("--strain", "--reach"),
               "diagnose e.toml -o new --dry-run": ("--levels", "--runs", "--confidence"), "convert p.vtp new.xyz": ("--diameter-um",),
               "convert p.vtp new.data": ("--density-kg-m3",), "reproduce swept -o new": ("--realisations",), "sweep sweep.toml -o new --dry-run": ("--threads",)}
    for command, names in numbers.items():
        for name in names:
            for value in ("nan", "inf", "''", "1e", "1,,2", "-1e300", "99999999999999999999", "%s%n", "1:2:0"):
                yield Row(f"option: {command.split()[0]} {name} {value}", f"$P {command} {name}={value} --quiet", (2, 3), "", plans)
    for words in ("", "no-such-command", "--no-such-option", "segment", "segment scan.mha", "segment scan.mha beads.csv -o new.csv", "pack -o new.vtp",
                  "compress p.vtp -o new", "render", "blind", "blind nothing", "sweep-run swept/store 0", "sweep-run swept/store ../../x",
                  "blind-case split.toml 99 -o new", "bridge --d-um 70 --paper", "convert p.vtp new.unknown", "convert p.vtp new",
                  "render run --view nothing -o new", "segment scan.mha -o new.csv -o other.csv", "--threads 2 --threads 3"):
        yield Row(f"option: \"{words}\"", f"$P {words} --quiet", (2, 3), "", plans, changes=("swept/store/index.sqlite*",))


def names():
    made = lambda name: lambda folder: (folder / name).exists()
    for name in ("ü ß 漢字.csv", "two\nlines.csv", "tab\there.csv", "a'b\"c$d`e.csv", "-o.csv", "a;b&c|d.csv", "*.csv", "~.csv", "…" * 60 + ".csv",
                 "x" * 200 + ".csv"):
        word = "./'" + name.replace("'", "'\\''") + "'"
        table = lambda folder, name=name: shutil.copy(folder / "beads.csv", folder / name)
        yield Row(f"name: input {name!r}", f"$P pack {word} --sample s.toml -o new.vtp --quiet", 0, "", table, changes=("new.*",),
                  then=made("new.vtp"))
        yield Row(f"name: output {name!r}", f"$P bridge --d-um 70 -o {word} --quiet", 0, "", changes=(re.sub(r"[*?\[]", "?", name),), then=made(name))
    for name in ("x" * 260 + ".csv", "absent/new.csv", "beads.csv/new.csv", "run", "run/", ".", "..", "/", "''", "/proc/new.csv", "/sys/new.csv",
                 "/dev/new/x.csv", "x_loop/new.csv"):
        yield Row(f"name: output {name[:20]!r} that cannot be", f"$P bridge --d-um 70 -o {name} --quiet", (2, 3, 4), "",
                  lambda folder: os.symlink("x_loop", folder / "x_loop"))
    for command in ("segment scan.mha", "pack beads.csv --sample s.toml", "compress p.vtp --sample s.toml", "render run --no-film", "sweep sweep.toml",
                    "phantom s.toml", "modulus p.vtp --sample s.toml", "track beads.csv beads.csv", "diagnose e.toml", "blind make split.toml",
                    "reproduce paper", "compress p.vtp --sample s.toml --realisations 2"):
        prepare = both(plans, lambda folder: [(folder / "paper").mkdir(), shutil.copy(folder / "s.toml", folder / "paper"),
                                              shutil.copy(folder / "sweep.toml", folder / "paper/realisations_a.toml")])
        for place in ("/proc/new", "beads.csv/new", "/dev/null", "/dev/full", "absent/a/../../beads.csv"):
            yield Row(f"place: {command} -o {place}", f"$P {command} -o {place} --quiet", (2, 3, 4), "", prepare, changes=("absent", "absent/*"))
    yield Row("name: a dangling link as output is replaced", "$P bridge --d-um 70 -o link.csv --quiet", 0, "",
              lambda folder: os.symlink("nowhere", folder / "link.csv"), changes=("link.csv",), then=made("link.csv"))


def inner_links():
    """Folders within one that is written, which are links to elsewhere."""
    for command, inner in (("blind make split.toml -o out", "cases"), ("blind make split.toml -o out", "sealed"), ("blind make split.toml -o out", "work"),
                           ("reproduce paper -o out", "realisations_a"), ("diagnose e.toml -o out --levels 1 --runs 0", "store/measured")):
        def prepare(folder, inner=inner):
            plans(folder)
            (folder / "paper").mkdir()
            shutil.copy(folder / "s.toml", folder / "paper")
            shutil.copy(folder / "sweep.toml", folder / "paper/realisations_a.toml")
            for name in ("case_001", "case_001/kept", "x"):
                (folder / "elsewhere" / name).mkdir(parents=True)
            (folder / "out" / inner).parent.mkdir(parents=True)
            os.symlink(folder / "elsewhere", folder / "out" / inner)
            (folder / "e.toml").write_text(EXPERIMENT.replace('"coordination"\nfile = "z.csv"', '"compression"\nfile = "run/curve.csv"\nbeads = "beads.csv"'))

        yield Row(f"10 {command.split(' -o')[0]}: {inner} is a link", f"$P {command} --quiet", 3, inner, prepare,
                  changes=("out", "out/*"))
    named = '[experiment]\nname = "../../../../stray"\nsample = "s.toml"\n[[observation]]\nkind = "compression"\nfile = "run/curve.csv"\n'
    yield Row("10 an experiment's name is no path",
              f"$P diagnose e.toml -o out --levels 1 --runs 0 --no-fresh-runs --leave-out {LEFT_OUT} --quiet", 0, "",
              both(plans, file("e.toml", named)), changes=("out", "out/*"), warns=True)


def same_places():
    """The place of an input as the place to write."""
    for command, status, changes in (("compress p.vtp --sample s.toml -o .", 0, ("curve.csv", "events.csv", "avalanches.csv", "result.json", "run.pvd", "frames*", "checkpoint*")),
                                     ("render run -o run", 0, ("run/*",)), ("sweep sweep.toml -o .", 0, ("store*", "results.csv", "summary.csv")),
                                     ("compress run/frames/frame_0002.vtp --sample s.toml -o run", (2, 3), ()),
                                     ("sweep swept/sweep.toml -o swept", 0, ("swept/*",)), ("blind score out out -o out", 3, ()),
                                     ("segment scan.mha -o beads.csv", 0, ("beads.*",)), ("convert beads.csv beads.vtp", 0, ("beads.vtp",))):
        yield Row(f"same place: {command}", f"$P {command} --quiet", status, "",
                  lambda folder: [shutil.copy(folder / name, folder / "swept") for name in ("s.toml", "sweep.toml")], changes=changes, warns=True)


QUICK = {"pack": "pack beads.csv --sample s.toml -o new.vtp", "compress": "compress p.vtp --sample s.toml -o new", "sweep": "sweep sweep.toml -o new",
         "segment": "segment scan.mha -o new.csv", "track": "track beads.csv beads.csv -o new.csv", "modulus": "modulus p.vtp --sample s.toml -o new.json",
         "bridge": "bridge --d-um 70 -o new.csv", "phantom": "phantom s.toml -o new.mha", "convert": "convert p.vtp new.data"}


def streams():
    for name, command in QUICK.items():
        for closed in ("<&-", ">&-", "2>&-", "<&- >&- 2>&-", ">/dev/full", "2>/dev/full"):
            yield Row(f"stream: {name} {closed}", f"$P {command} --quiet {closed}", 0, "", changes=("new*",),
                      then=lambda folder: any(folder.glob("new*")))
    yield Row("stream: a table into a pipe that closes", "$P bridge --d-um 50:150:40 | true; exit ${PIPESTATUS[0]}", (4, 141), "")
    yield Row("stream: the help into a pipe that closes", "$P segment --help | true; exit ${PIPESTATUS[0]}", (0, 4, 141), "")


def environments():
    for name, command in QUICK.items():
        for setting in ("LC_ALL=de_DE.UTF-8", "LC_ALL=xx_YY", "LC_NUMERIC=de_DE.UTF-8 LANG=de_DE.UTF-8 LC_ALL=", "-u HOME -u PATH", "TZ=:/etc/passwd",
                        "OMP_NUM_THREADS=-5 TBB_NUM_THREADS=x", "TERM=%s%n COLUMNS=-1", "LANGUAGE=../../etc"):
            yield Row(f"environment: {name} {setting}", f"env {setting} $P {command} --quiet", 0, "", changes=("new*",),
                      then=lambda folder: any(folder.glob("new*")))
    yield Row("environment: no folder for temporary files", "TMPDIR=/nowhere $P sweep sweep.toml -o new --quiet", (0, 3, 4), "", changes=("new*",))
    for command in ("render run -o new --no-film", "bridge s.toml --d-um 50,60 -o new.csv --plot new.png"):
        yield Row(f"environment: {command.split()[0]} without a display", f"env -u DISPLAY -u XAUTHORITY $P {command} --quiet", 0, "", changes=("new*",))
        yield Row(f"environment: {command.split()[0]} with a false display", f"DISPLAY=:99999 $P {command} --quiet", 0, "", changes=("new*",))


def full_discs():
    """No file may grow beyond some blocks of 1024 bytes."""
    for name, (blocks, command) in {"compress": (1, QUICK["compress"]), "sweep": (8, QUICK["sweep"]), "track": (1, QUICK["track"]),
                                    "modulus": (0, QUICK["modulus"]), "bridge": (0, QUICK["bridge"]), "render": (4, "render run -o new --no-film"),
                                    "segment": (1, QUICK["segment"]), "pack --generate": (1, "pack --generate --sample s.toml -o new.vtp")}.items():
        yield Row(f"16 full disc in {name}", f"(ulimit -f {blocks}; trap '' XFSZ; $P {command} --quiet) 2>&1 | cat >&2; exit ${{PIPESTATUS[0]}}", (3, 4), "", changes=("new/*", "new"),
                  then=lambda folder: not any((folder / "new").rglob("result.json")) and not list(folder.glob("new.*")))


def rows():
    yield from wrong_kinds()
    yield from cuts()
    yield from keys()
    yield from options()
    yield from names()
    yield from inner_links()
    yield from same_places()
    yield from streams()
    yield from environments()
    yield from full_discs()
