"""Common functions of the scripts that measure."""

import argparse
import csv
import io
import os
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))


def say(text):
    print(text, file=sys.stderr, flush=True)


def fail(text):
    sys.exit(f"error: {text}")


def parser_of(head):
    """An argument parser whose help begins with the docstring of a script."""
    return argparse.ArgumentParser(description=head, formatter_class=argparse.RawDescriptionHelpFormatter)


def refuse_missing(paths):
    for path in paths:
        if not path.exists():
            fail(f"{path} does not exist")


def find_corniche():
    return shutil.which(os.environ.get("CORNICHE", "corniche")) or fail("corniche is not on the path; name it in CORNICHE")


def write_whole(path, text):
    """Writes a file completely or not at all."""
    part = path.with_name(f".{path.name}.unfinished")
    part.write_text(text)
    part.replace(path)


def write_table(path, columns, rows):
    """Writes a table completely or not at all."""
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    write_whole(path, text.getvalue())
