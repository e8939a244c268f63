"""Stores of runs, run folders and checkpoints: what was in them is replaced, cut or foreign."""
import shutil
import sqlite3

from row import Row, file

SWEEP = "$P sweep sweep.toml -o swept --quiet"
STORE = "swept/store"


def run_of(folder, number=0):
    return sorted(path for path in (folder / STORE / "runs").iterdir())[number]


def result(content):
    return lambda folder: (run_of(folder) / "result.json").write_text(content)


def of_another(folder):
    shutil.copy(run_of(folder, 1) / "result.json", run_of(folder) / "result.json")


def without_index(folder):
    for path in (folder / STORE).glob("index.sqlite*"):
        path.unlink()


def failed(content):
    """A run that failed, in a store that lost its index."""

    def prepare(folder):
        run = run_of(folder)
        (run / "result.json").unlink()
        (run / "failed.json").write_text(content)
        run.rename(run.with_name(run.name + ".part"))
        without_index(folder)

    return prepare


def sql(*statements):
    def prepare(folder):
        with sqlite3.connect(folder / STORE / "index.sqlite") as index:
            for statement in statements:
                index.execute(statement)

    return prepare


def results():
    for name, content in {"{}": "{}", "[]": "[]", "null": "null", "nothing": "", "half": '{"linear_modulus_pa": {"val', "a number": "3",
                          "words": '{"linear_modulus_pa": "x", "beads": "y"}', "deep": "[" * 100_000}.items():
        yield Row(f"17 result.json is {name}", SWEEP, 3, "result.json", result(content))
    yield Row("17 result.json is another run's", SWEEP, 3, "result.json", of_another)
    yield Row("17 result.json is gone", SWEEP, 3, "result.json", lambda folder: (run_of(folder) / "result.json").unlink())
    for name, content in {"{}": "{}", "wrong kinds": '{"exit_status": "x", "message": 3}', "no object": "[1]", "half": '{"exit',
                          "huge": '{"exit_status": 1e300, "message": ""}'}.items():
        yield Row(f"17 index lost, failed.json is {name}", SWEEP, 0, prepare=failed(content), changes=("swept/*",), warns=True)


def indices():
    for name, statements in {
            "a trigger that hides": ["CREATE TRIGGER t AFTER UPDATE ON runs BEGIN UPDATE runs SET status='done' WHERE hash=new.hash; END"],
            "a trigger that deletes": ["CREATE TRIGGER t AFTER INSERT ON runs BEGIN DELETE FROM runs; END"],
            "a view": ["CREATE VIEW v AS SELECT * FROM runs"], "another table": ["CREATE TABLE other (x)"],
            "no table": ["DROP TABLE runs"], "a column less": ["ALTER TABLE runs DROP COLUMN message"],
            "another version": ["PRAGMA user_version = 99"], "a negative version": ["PRAGMA user_version = -1"]}.items():
        yield Row(f"17 index with {name}", SWEEP, 3, "index.sqlite", sql(*statements), changes=("swept/store/index.sqlite*",))
    for name, content in {"text": "hello", "zeros": bytes(8192), "nothing but its head": b"SQLite format 3\0"}.items():
        yield Row(f"17 index is {name}", SWEEP, 3, "index.sqlite", file(STORE + "/index.sqlite", content),
                  changes=("swept/store/index.sqlite*",))
    yield Row("17 index with a request that is none", SWEEP, 0, prepare=sql("UPDATE runs SET status = 'done', request = 'x'"),
              changes=("swept/*",))


def run_folders():
    for name in ("curve.csv", "result.json", "frames/frame_0000.vtp"):
        for word, content in {"empty": "", "zeros": bytes(1000), "[1]": "[1]"}.items():
            yield Row(f"render a run whose {name} is {word}", "$P render run -o out --no-film --quiet", 3, name.split("/")[-1],
                      file("run/" + name, content))
    for odd in ("inf", "nan", "1e300", ""):
        yield Row(f"19 render a curve with \"{odd}\"", "$P render run -o out --no-film --quiet", 3, "curve.csv",
                  file("run/curve.csv", f"strain,stress_pa\n0,0\n0.001,{odd}\n0.002,3\n"))
    for word, content in {"empty": "", "zeros": bytes(5000), "text": "hello"}.items():
        yield Row(f"resume from a checkpoint that is {word}", "$P compress p.vtp --sample s.toml -o run --resume --quiet", 3, "checkpoint",
                  file("run/checkpoint", content))


def rows():
    yield from results()
    yield from indices()
    yield from run_folders()
