"""Tables, packings, samples and experiments: numbers that cannot be, files that are cut."""
import os
import random

from row import SAMPLE, Row, both, file

BEADS = "bead_id,x_um,y_um,z_um,diameter_um,sigma_centre_um,sigma_diameter_um,quality,boundary\n"
NUMBERS = ("nan", "inf", "-inf", "1e300", "-1e300", "1e7", "9" * 400, "0x10", "1e", "--1", "١")


def table(odd, column, rows=12):
    """Beads in a row, one of them odd."""
    names = BEADS.strip().split(",")
    lines = [BEADS]
    for k in range(rows):
        cells = dict(zip(names, (str(k + 1), "0", "0", str(205 * k), "200", "0.1", "0.1", "1", "0")))
        if k == 5:
            cells[column] = odd
        lines.append(",".join(cells.values()) + "\n")
    return "".join(lines)


def bead_tables():
    for column in ("x_um", "z_um", "diameter_um", "sigma_centre_um", "sigma_diameter_um", "quality", "boundary"):
        for odd in NUMBERS + (("-1",) if column not in ("x_um", "z_um") else ()):
            if odd == "1e7" and column == "z_um":
                yield Row("7 track a bead at 1e7 um", "$P track b.csv beads.csv -o t.csv", 3, "b.csv:7",
                          file("b.csv", table(odd, column)))
                yield Row("7 convert a bead at 1e7 um", "$P convert b.csv c.vtp", 3, "b.csv:7",
                          file("b.csv", table(odd, column)))
            yield Row(f"7 {column} {odd[:8]}", "$P pack b.csv --sample s.toml -o new.vtp", 3, "b.csv:7",
                      file("b.csv", table(odd, column)))
    for odd in ("1e30", "nan", "inf", "10"):
        yield Row(f"7 Yade text with {odd}", "$P convert b.txt c.csv", 3, "b.txt",
                  file("b.txt", f"0 0 0 1e-4\n0 0 {odd} 1e-4\n"))
        yield Row(f"7 LAMMPS data with {odd}", "$P convert b.data c.csv", 3, "b.data",
                  file("b.data", f"title\n2 atoms\n\nAtoms # sphere\n\n1 1 2e-4 2500 0 0 0\n2 1 2e-4 2500 0 0 {odd}\n"))
    for command in ("pack {} --sample s.toml -o new.vtp", "pack beads.csv --sample {} -o new.vtp", "convert {} new.csv --from vtp",
                    "compress {} --sample s.toml -o new", "sweep {} -o new", "diagnose {} -o new", "modulus {} --sample s.toml -o new.json"):
        yield Row(f"a device for {command}", "$P " + command.format("/dev/zero"), 3, "/dev/zero")
        yield Row(f"a pipe for {command}", "mkfifo f; $P " + command.format("f"), 3, "f: is a device or a pipe", changes=("f",))
    for name, data in {"empty": "", "only a header": BEADS, "binary": bytes(range(256)) * 300, "zeros": bytes(100_000),
                       "one long line": b"x" * 5_000_000, "no end": b'bead_id,x_um,y_um,z_um,diameter_um\n"1,0,0,0'}.items():
        yield Row(f"bead table {name}", "$P pack b.csv --sample s.toml -o new.vtp", 3, "b.csv", file("b.csv", data))


def bridge_tables():
    head = "bead_i,bead_j,gap_um,sigma_gap_um,probability,bridge_diameter_um,sigma_bridge_diameter_um,state\n"
    names = head.strip().split(",")
    for column in names[2:7]:
        for odd in ("nan", "inf", "-1", "1e300") if column != "gap_um" else ("nan", "inf", "1e300"):
            cells = dict(zip(names, ("1", "2", "5", "0.1", "0.9", "70", "2", "bridge")))
            cells[column] = odd
            yield Row(f"18 bridges.csv {column} {odd}", "$P pack b.csv --bridges g.csv --sample s.toml -o new.vtp", 3,
                      "g.csv:2", both(file("b.csv", table("200", "diameter_um")), file("g.csv", head + ",".join(cells.values()) + "\n")), warns=True)


def vtp(points="0 0 0 0 0 205", count="2", components="3", diameter="200 200", lines="0", more="", tuples="", ends="0 1",
        offsets="2", field="1", boundary="0 0", head='version="0.1" byte_order="LittleEndian"', gap="5"):
    def array(name, values, kind="Float64", extra=""):
        return f'<DataArray type="{kind}" Name="{name}" format="ascii" {extra}>{values}</DataArray>'

    fields = "".join(array(name, value) for name, value in (
        ("format_version", field), ("specimen_diameter_um", "1000"), ("specimen_height_um", "1000"),
        ("specimen_axis_x_um", "0"), ("specimen_axis_y_um", "0"), ("specimen_bottom_um", "-100")))
    beads = (array("bead_id", "1 2", "Int64") + array("diameter_um", diameter, extra=tuples) + array("boundary", boundary, "Int64") +
             "".join(array(name, "0 0") for name in ("sigma_centre_um", "sigma_diameter_um", "quality")))
    bridges = "".join(array(name, value) for name, value in (
        ("gap_um", gap), ("sigma_gap_um", "0"), ("probability", "1"), ("bridge_diameter_um", "70"),
        ("sigma_bridge_diameter_um", "0"))) + array("state", "1", "Int64")
    return (f'<VTKFile type="PolyData" {head}><PolyData><FieldData>{fields}</FieldData>'
            f'<Piece NumberOfPoints="{count}" NumberOfVerts="0" NumberOfLines="{lines}" NumberOfStrips="0" NumberOfPolys="0">'
            f'<PointData>{beads}</PointData><CellData>{bridges if lines == "1" else ""}</CellData>'
            f'<Points><DataArray type="Float64" NumberOfComponents="{components}" format="ascii">{points}</DataArray></Points>'
            f'<Lines>{array("connectivity", ends, "Int64")}{array("offsets", offsets, "Int64")}</Lines>{more}</Piece></PolyData></VTKFile>\n')


def packings():
    def row(name, text, says="b.vtp", status=3):
        return Row(name, "$P convert b.vtp c.csv", status, says, file("b.vtp", text), changes=("c.csv",) if status == 0 else ())

    yield row("a packing by hand", vtp(), "", 0)
    yield row("a packing with a bridge by hand", vtp(lines="1"), "", 0)
    for number in ("4294967296", "-1", "0", "99999999999999999999", "three", "2", "1e1"):
        yield row(f"8 NumberOfComponents {number}", vtp(components=number))
    for number in ("4294967296", "-1", "0", "9223372036854775807", "3", "1"):
        yield row(f"8 NumberOfPoints {number}", vtp(count=number))
        yield row(f"8 NumberOfLines {number}", vtp(lines=number if number not in ("0", "1") else "-2"))
    for number in ("4294967296", "-1", "x"):
        yield row(f"8 NumberOfTuples {number}", vtp(tuples=f'NumberOfTuples="{number}"'))
    for number in ("nan", "inf", "-1", "1e300", "0"):
        yield row(f"18 .vtp diameter {number}", vtp(diameter=f"200 {number}"))
        if number not in ("-1", "0"):
            yield row(f"18 .vtp point {number}", vtp(points=f"0 0 0 0 0 {number}"))
            yield row(f"18 .vtp field {number}", vtp(field=number))
            yield row(f"18 .vtp gap {number}", vtp(lines="1", gap=number))
    yield row("8 .vtp a bead at 1e7 um", vtp(points="0 0 0 0 0 1e7"))
    yield row("8 .vtp lines to nowhere", vtp(lines="1", ends="0 7"))
    yield row("8 .vtp offsets that fall", vtp(lines="1", offsets="-9223372036854775808"))
    yield row("8 .vtp with entities", '<!DOCTYPE x [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>' + vtp())
    yield row("8 .vtp of an unknown compressor", vtp(head='version="1.0" compressor="vtkNoSuchCompressor"'))
    yield row("8 .vtp of unknown heads", vtp(head='header_type="UInt7"'))
    yield row("8 .vtp nested deep", '<VTKFile type="PolyData">' + "<a>" * 100_000 + "</VTKFile>\n")
    for name, data in {"negative": "_////////", "none": "", "short": "_AQ", "no base64": "_$$$$$$$$$$$$$$$$"}.items():
        text = vtp().replace('format="ascii"', 'format="appended" offset="0"').replace(
            "</PolyData>", f'</PolyData><AppendedData encoding="base64">{data}</AppendedData>')
        yield row(f"8 .vtp appended data {name}", text)
        yield row(f"8 .vtp appended and compressed data {name}",
                  text.replace("<VTKFile ", '<VTKFile compressor="vtkZLibDataCompressor" header_type="UInt64" '))
    yield row("8 .vtp offset beyond", vtp().replace('format="ascii"', 'format="appended" offset="18446744073709551615"'))


def sections():
    """SAMPLE cut after each of its sections."""
    at = [k for k in range(len(SAMPLE)) if SAMPLE[k] == "[" and (k == 0 or SAMPLE[k - 1] == "\n")]
    return {SAMPLE[k + 1:SAMPLE.index("]", k)]: SAMPLE[:k] for k in at if not SAMPLE[k:].startswith("[phantom]")}


def samples():
    commands = {"pack": "$P pack beads.csv --sample c.toml -o new.vtp", "pack --generate": "$P pack --generate --sample c.toml -o new.vtp",
                "compress": "$P compress p.vtp --sample c.toml -o new", "phantom": "$P phantom c.toml -o new.mha",
                "modulus": "$P modulus p.vtp --sample c.toml -o new.json", "bridge": "$P bridge c.toml -o new.csv",
                "sweep": "$P sweep c_sweep.toml -o new", "diagnose": "$P diagnose e.toml -o new"}
    others = both(file("c_sweep.toml", '[sweep]\nsample = "c.toml"\n'),
                  file("e.toml", '[experiment]\nsample = "c.toml"\n[[observation]]\nkind = "coordination"\nfile = "z.csv"\n'),
                  file("z.csv", "z,z_sigma\n7,0.1\n"))
    for command, line in commands.items():
        for section, text in sections().items():
            yield Row(f"9 {command} of a sample cut before [{section}]", line, 3, "c.toml", both(others, file("c.toml", text)))
    keys = [line.split(" ")[0] for line in SAMPLE.splitlines() if line and line[0] != "["]
    for key in sorted(set(keys) - {"normal_stiffness_n_per_m", "tangential_stiffness_n_per_m", "volume_fraction", "frames",
                                   "voxel_um", "wall_thickness_um", "margin_um", "diameters", "bond_friction_limit"}):
        line = next(line for line in SAMPLE.splitlines(True) if line.startswith(key + " "))
        yield Row(f"9 a sample without {key}", commands["pack"], 3, key, file("c.toml", SAMPLE.replace(line, "", 1)))
    for key in ("diameters", "bond_friction_limit"):
        line = next(line for line in SAMPLE.splitlines(True) if line.startswith(key + " "))
        yield Row(f"9 an older version's sample without {key}", "$P bridge c.toml -o new.csv", 0, key,
                  file("c.toml", SAMPLE.replace(line, "")), changes=("new.csv",))
    for value in ("9e18", "9000000000000000001", "9007199254740993", "-9223372036854775808", "nan", "inf", "1e400", '"x"', "[1]"):
        yield Row(f"15 volume_fraction = {value}", commands["pack --generate"], 3, "c.toml",
                  file("c.toml", SAMPLE.replace("volume_fraction = 0.53", f"volume_fraction = {value}")))
        yield Row(f"15 realisations = {value}", "$P sweep c.toml -o new", 3, "c.toml",
                  file("c.toml", f'[sweep]\nsample = "s.toml"\nrealisations = {value}\n'))
    yield Row("15 a deep table", commands["pack"], 3, "c.toml", file("c.toml", "a=" + "[" * 5000))


def experiments():
    head = '[experiment]\nsample = "s.toml"\n[[observation]]\nkind = "{}"\nfile = "t.csv"\n'

    def row(name, kind, text, says="t.csv"):
        return Row("12 " + name, "$P diagnose e.toml -o new --dry-run", 3, says, both(file("e.toml", head.format(kind)), file("t.csv", text)))

    good = "d_um,D_um,kn_n_per_m,kn_sigma_n_per_m\n"
    yield row("bridges in mm", "bridge_stiffness", good + "0.074,0.2,5700,100\n0.08,0.2,6100,100\n")
    yield row("necks in mm", "bridge_stiffness", good + "0.074,200,5700,100\n0.08,200,6100,100\n")
    yield row("stiffness in kN/m", "bridge_stiffness", good + "74,200,5.7,0.1\n80,200,6.1,0.1\n")
    yield row("stiffness in mN/m", "bridge_stiffness", good + "74,200,5.7e6,100\n80,200,6.1e6,100\n")
    yield row("one row in mm", "bridge_stiffness", good + "74,200,5700,100\n0.08,0.2,6100,100\n80,200,6100,100\n")
    yield row("one row in kN/m", "bridge_stiffness", good + "74,200,5700,100\n80,200,6.1,0.1\n80,200,6100,100\n")
    yield row("errors of 1e12 N/m", "bridge_stiffness", good + "74,200,5700,1e12\n80,200,6100,1e12\n")
    noisy = "strain,stress_pa,stress_sigma_pa\n"
    yield row("stress errors of 1e12 Pa", "compression", noisy + "".join(f"{k / 100},{5e4 * k * k},1e12\n" for k in range(10)))
    yield row("one stress error of 1e12 Pa", "compression",
              noisy + "".join(f"{k / 100},{5e4 * k * k},{'1e12' if k == 4 else '1e3'}\n" for k in range(10)))
    rows = [f"{k / 100},{5e4 * k * k}\n" for k in range(10)]
    yield row("a curve reversed", "compression", "strain,stress_pa\n" + "".join(reversed(rows)))
    yield row("a curve shuffled", "compression", "strain,stress_pa\n" + "".join(random.Random(1).sample(rows, len(rows))))
    yield row("a curve in per cent", "compression", "strain,stress_pa\n" + "".join(f"{k},{5e4 * k * k}\n" for k in range(10)))
    for odd in ("nan", "inf", "1e300", ""):
        yield row(f"a stress of \"{odd}\"", "compression", "strain,stress_pa\n" + "".join(rows[:5]) + f"0.055,{odd}\n" + "".join(rows[6:]))
    for kind, text in {"lateral_strain": "strain,lateral_strain\n0.01,nan\n0.02,0.1\n", "coordination": "z,z_sigma\n-3,0.1\n",
                       "bridge_diameters": "d_um\n-70\n70\n60\n", "bridge_gaps": "gap_um\n1e7\n2\n3\n",
                       "broken_bonds": "strain,count\n0.01,-5\n0.02,3\n", "modulus_series": "W,modulus_pa,modulus_sigma_pa\n0.02,1e300,1\n0.01,1e6,1\n"}.items():
        yield row(f"{kind} that cannot be", kind, text)


def files_beside():
    """Files that an experiment, a split or a sweep names."""
    for name, word in {"too long": "x" * 300, "a circle": "circle", "a folder": "run", "a device": "/dev/zero", "empty": ""}.items():
        circle = lambda folder: os.symlink("circle", folder / "circle")
        yield Row(f"12 an experiment whose sample is {name}", "$P diagnose e.toml -o new", 3, "",
                  both(circle, file("e.toml", f'[experiment]\nsample = "{word}"\n')))
        yield Row(f"12 an observation whose file is {name}", "$P diagnose e.toml -o new", 3, "",
                  both(circle, file("e.toml", f'[experiment]\nsample = "s.toml"\n[[observation]]\nkind = "coordination"\nfile = "{word}"\n')))
        yield Row(f"12 a sweep whose sample is {name}", "$P sweep w.toml -o new", 3, "", both(circle, file("w.toml", f'[sweep]\nsample = "{word}"\n')))
        yield Row(f"12 a sweep whose packing is {name}", "$P sweep w.toml -o new", 3, "",
                  both(circle, file("w.toml", f'[sweep]\nsample = "s.toml"\npacking = "{word}"\n')))


def messages():
    red = "\x1b[31mred\x07\u202e"
    yield Row("19 colour codes in a cell", "$P pack b.csv --sample s.toml -o new.vtp", 3, "b.csv:7", file("b.csv", table(red, "x_um")))
    yield Row("19 70 kB in a cell", "$P pack b.csv --sample s.toml -o new.vtp", 3, "b.csv", file("b.csv", table("7" * 70_000 + "x", "x_um")))
    yield Row("19 control bytes in a key", "$P pack beads.csv --sample c.toml -o new.vtp", 3, "c.toml", file("c.toml", '[beads]\n"a\\u001b[2J" = 1\n'))
    yield Row("19 70 kB in a key", "$P pack beads.csv --sample c.toml -o new.vtp", 3, "c.toml", file("c.toml", "[beads]\n" + "k" * 70_000 + " = 1\n"))
    yield Row("19 control bytes in a name", "$P pack $'b\\033[31m\\n.csv' --sample s.toml -o new.vtp", 3, "no such file")
    yield Row("19 bytes that are no UTF-8 in a name", "$P pack $'b\\377.csv' --sample s.toml -o new.vtp", 3, "no such file")
    yield Row("19 a file's own words", "$P segment v.mha -o new.csv", 3, "v.mha",
              file("v.mha", b"NDims = 3\nDimSize = \x1b[31m\xff 4 4\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n"))
    yield Row("19 no addresses of objects", "$P segment v.tif -o new.csv", 3, "v.tif", file("v.tif", b"II*\0\x08\0\0\0\xff\xff" + bytes(50)))


def rows():
    yield from bead_tables()
    yield from bridge_tables()
    yield from packings()
    yield from samples()
    yield from experiments()
    yield from files_beside()
    yield from messages()
