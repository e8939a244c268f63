"""Volumes: headers that lie, format strings, slices that are missing."""
import gzip
import os
import random
import struct

from row import Row, both, file

SIZE = (6, 5, 4)
VOXELS = bytes(range(2, 242))  # 120 of 16 bit
SEGMENT = "$P segment {} -o new.csv --quiet"


def meta(data="LOCAL", more="", size="6 5 4", kind="MET_USHORT", dims="3", spacing="10 10 10"):
    return (f"ObjectType = Image\nNDims = {dims}\nBinaryData = True\nBinaryDataByteOrderMSB = False\n{more}"
            f"ElementSpacing = {spacing}\nDimSize = {size}\nElementType = {kind}\nElementDataFile = {data}\n").encode()


def nrrd(more="", kind="ushort", sizes="6 5 4", encoding="raw", dimension="3"):
    return (f"NRRD0004\ntype: {kind}\ndimension: {dimension}\nsizes: {sizes}\nendian: little\nencoding: {encoding}\n"
            f"spacings: 10 10 10\n{more}").encode()


def bad(name, header, data=VOXELS, says="", extension=".mha"):
    volume = "v" + extension
    return Row(name, SEGMENT.format(volume), 3, says or volume, file(volume, header + data))


def slices(missing=(), cut=(), names="s{:02d}.raw"):
    def write(folder):
        for k in range(1, 5):
            if k not in missing:
                (folder / names.format(k)).write_bytes(VOXELS[60 * (k - 1):60 * k - (7 if k in cut else 0)])

    return write


def format_strings():
    for k, pattern in enumerate(("%s%s%s%n 1 36 1", "%1000000000d 1 4 1", "%n", "%d%d 1 4 1", "%*d 1 4 1", "%.9999d 1 4",
                                 "s%02d.raw 1 99999999999999999999 1", "s%02d.raw 1 4 0", "s%02d.raw 4 1 1", "%", "%d",
                                 "s%02d.raw 1 1000000000 1", "s%-3d.raw 1 4", "s%02ld.raw 1 4 1")):
        yield Row(f"2 format string {k} in .mhd", SEGMENT.format("v.mhd"), 3, "ElementDataFile",
                  both(slices(), file("v.mhd", meta(pattern))))
        yield Row(f"2 format string {k} in .nhdr", SEGMENT.format("v.nhdr"), 3, "datafile",
                  both(slices(), file("v.nhdr", nrrd(f"data file: {pattern}\n"))))


def slice_lists():
    names = "".join(f"s{k:02d}.raw\n" for k in range(1, 5))
    for word, broken in (("missing", dict(missing=[2])), ("cut", dict(cut=[2])), ("last missing", dict(missing=[4])),
                         ("first cut", dict(cut=[1]))):
        for kind, header in (("LIST", meta("LIST\n" + names)), ("LIST 2", meta("LIST 2\n" + names)),
                             ("pattern", meta("s%02d.raw 1 4 1"))):
            yield Row(f"5 slice {word} of {kind}", SEGMENT.format("v.mhd"), 3, "s0",
                      both(slices(**broken), file("v.mhd", header)))
        yield Row(f"5 slice {word} of an NRRD's list", SEGMENT.format("v.nhdr"), 3, "s0",
                  both(slices(**broken), file("v.nhdr", nrrd("data file: LIST\n" + names))))
    for name, data in (("short list", "LIST\ns01.raw\ns02.raw\n"), ("long list", "LIST\n" + names + "s01.raw\n"),
                       ("empty list", "LIST\n"), ("short pattern", "s%02d.raw 1 3 1"), ("list of 3", "LIST 3\n" + names),
                       ("one for all", "LIST\ns01.raw\n")):
        yield Row(f"5 {name}", SEGMENT.format("v.mhd"), 3, "ElementDataFile",
                  both(slices(), file("v.mhd", meta(data))))


def sizes():
    huge = {"overflow 2^64": "4294967296 4294967296 2", "overflow to fit": "4294967296 4294967296 16",
            "27 Gvoxel": "3000 3000 3000", "9e18": "9223372036854775807 1 1", "beyond 64 bit": "99999999999999999999 1 1",
            "negative": "-6 5 4", "zero": "6 5 0", "of words": "six 5 4", "two": "6 5", "fraction": "6.5 5 4"}
    for name, size in huge.items():
        yield bad(f"4 DimSize {name}", meta(size=size))
        yield bad(f"4 sizes {name}", nrrd(sizes=size) + b"\n", extension=".nrrd")
        yield Row(f"4 DimSize {name} with LIST", SEGMENT.format("v.mhd"), 3, "v.mhd",
                  both(slices(), file("v.mhd", meta("LIST\ns01.raw\n", size=size))))
        yield Row(f"13 {name} over a detached file", SEGMENT.format("v.mhd"), 3, "v.",
                  both(file("v.raw", VOXELS), file("v.mhd", meta("v.raw", size=size))))
        packed = gzip.compress(VOXELS)
        yield bad(f"13 {name} over compressed data", meta(more="CompressedData = True\n", size=size), packed)
        yield bad(f"13 {name} over a gzip NRRD", nrrd(sizes=size, encoding="gzip") + b"\n", packed, extension=".nrrd")
    short = gzip.compress(random.Random(1).randbytes(40_000) + bytes(4 << 20))
    yield bad("13 compressed data that do not fill the volume", meta(more="CompressedData = True\n", size="128 128 1000"),
              short, "once inflated")
    yield Row("13 TIFF of a size that is not there", SEGMENT.format("v.tif"), 3, "v.tif", file("v.tif", tiff(30000, 30000)))


def tiff(width, height):
    tags = [(256, 4, 1, width), (257, 4, 1, height), (258, 3, 1, 16), (259, 3, 1, 1), (262, 3, 1, 1), (273, 4, 1, 8),
            (277, 3, 1, 1), (278, 4, 1, height), (279, 4, 1, 100)]
    entries = b"".join(struct.pack("<HHII", *tag) for tag in tags)
    return b"II*\0" + struct.pack("<I", 8) + struct.pack("<H", len(tags)) + entries + bytes(4) + bytes(100)


def headers():
    for kind in ("block", "void", "int128", "ushort ushort", "", "USHORT", "double", "signed char", "%n"):
        yield bad(f"3 NRRD of type \"{kind}\"", nrrd(kind=kind) + b"\n", extension=".nrrd")
        yield bad(f"3 MetaImage of type \"{kind}\"", meta(kind=kind or "MET_NONE"))
    for dims in ("1000000", "-1", "0", "2", "99999999999999999999", "three", "4"):
        yield bad(f"6 NDims {dims}", meta(dims=dims))
        yield bad(f"6 dimension {dims}", nrrd(dimension=dims) + b"\n", extension=".nrrd")
    for edge in ("nan", "inf", "-1", "0", "1e300", "1e-300", "x", ""):
        yield bad(f"18 ElementSpacing {edge}", meta(spacing=f"{edge} 10 10"))
        yield bad(f"18 spacings {edge}", nrrd().replace(b"spacings: 10", f"spacings: {edge}".encode()) + b"\n",
                  extension=".nrrd")
        yield bad(f"18 Offset {edge}", meta(more=f"Offset = {edge if edge not in ('-1', '0', '1e-300') else 'nan'} 0 0\n"))
        yield bad(f"18 space directions {edge}",
                  nrrd().replace(b"spacings: 10 10 10", f"space directions: ({edge},0,0) (0,10,0) (0,0,10)".encode()
                                 if edge not in ("-1",) else b"space directions: (1,0) (0,1)") + b"\n", extension=".nrrd")
    yield bad("fields twice", meta(more="DimSize = 1 1 1\n"), says="DimSize")
    yield bad("channels", meta(more="ElementNumberOfChannels = 3\n"), says="components")
    yield bad("header without data", meta()[:60], b"")
    yield bad("a line without end", b"NDims = 3" + b" " * 3_000_000, b"")
    yield bad("zeros", bytes(3_000_000), b"")
    yield bad("a voxel too many", meta(), VOXELS + b"\0\0", "expected 240")
    yield bad("a voxel too few", nrrd() + b"\n", VOXELS[:-2], "expected 240", ".nrrd")
    yield bad("NRRD of bzip2", nrrd(encoding="bzip2") + b"\n", says="encoding", extension=".nrrd")
    yield bad("NRRD that skips backwards", nrrd("byte skip: -2\n") + b"\n", extension=".nrrd")
    yield bad("NRRD that skips far", nrrd("byte skip: 9223372036854775807\n") + b"\n", extension=".nrrd")
    for target in ("/dev/zero", "/dev/stdin", "v.mhd/..", "", "absent.raw", "."):
        yield Row(f"data in \"{target}\"", SEGMENT.format("v.mhd"), 3, "ElementDataFile", file("v.mhd", meta(target)))
    yield Row("a volume that is a device", SEGMENT.format("/dev/zero --size 6,5,4 --type uint16 --voxel-um 10"), 3, "/dev/zero")
    yield Row("a pipe as volume", SEGMENT.format("v.mha"), 3, "v.mha", lambda folder: os.mkfifo(folder / "v.mha"))


PCR = "[VolumeData]\nVOL_File={}\nVoxelSizeRec=0.01\nFormat=5\nVolume_SizeX=6\nVolume_SizeY=5\nVolume_SizeZ=4\n"


def beside():
    """Files that a volume is told to have beside it, which cannot be."""
    for name, word in {"too long": "x" * 300, "a circle": "circle.vol", "empty": "", "a folder": "run", "up": "../../etc/passwd"}.items():
        yield Row(f"5 a .pcr whose data are {name}", SEGMENT.format("v.pcr"), 3, "cannot be seen" if name == "a circle" else "v.pcr",
                  both(file("v.pcr", PCR.format(word)), lambda folder: os.symlink("circle.vol", folder / "circle.vol")))
        yield Row(f"5 a .mhd whose data are {name}", SEGMENT.format("v.mhd"), 3, "ElementDataFile",
                  both(file("v.mhd", meta(word)), lambda folder: os.symlink("circle.vol", folder / "circle.vol")))
        yield Row(f"5 a .nhdr whose data are {name}", SEGMENT.format("v.nhdr"), 3, "data",
                  both(file("v.nhdr", nrrd(f"data file: {word}\n")), lambda folder: os.symlink("circle.vol", folder / "circle.vol")))
    yield Row("5 slices among which a link leads in a circle", SEGMENT.format("slices --voxel-um 10"), 3, "slices/s2.png",
              both(file("slices/s1.png", b""), lambda folder: os.symlink("s2.png", folder / "slices/s2.png")))
    yield Row("5 a name too long for a volume", SEGMENT.format("x" * 300 + ".mha"), 3, "cannot be seen")


def rows():
    yield from beside()
    yield from format_strings()
    yield from slice_lists()
    yield from sizes()
    yield from headers()
