"""CSV and JSON files as heel writes them."""

import csv
import json

import numpy as np


class BadInput(Exception):
    """What is wrong with which file, in one line."""


class Table:
    """A CSV file with one header line: table["yaw_deg"] is the column, as numbers where all its cells are."""

    def __init__(self, path):
        self.path = path
        try:
            with open(path, newline="", encoding="utf-8") as file:
                rows = list(csv.reader(file))
        except (OSError, UnicodeDecodeError) as error:
            raise BadInput(f"{path}: cannot read: {error} (expected a CSV file of heel)") from error
        if not rows:
            raise BadInput(f"{path}: empty (expected a CSV file with a header line)")
        for number, row in enumerate(rows, start=1):
            if len(row) != len(rows[0]):
                raise BadInput(
                    f"{path}:{number}: {len(row)} cells (expected {len(rows[0])} as in the header)"
                )
        cells = list(zip(*rows[1:])) if len(rows) > 1 else [()] * len(rows[0])
        self.columns = dict(zip(rows[0], cells))

    def text(self, name):
        """The column's cells as they stand in the file."""
        if name not in self.columns:
            raise BadInput(f"{self.path}: no column '{name}' (expected a file of this version of heel)")
        return list(self.columns[name])

    def __getitem__(self, name):
        try:
            return np.array(self.text(name), dtype=float)
        except ValueError as error:
            raise BadInput(f"{self.path}: column {name}: {error} (expected numbers)") from error

    def __len__(self):
        return len(next(iter(self.columns.values())))


class Numbers(dict):
    """An object of a JSON file, which names the file where a key is missing."""

    def __init__(self, path, pairs):
        super().__init__(pairs)
        self.path = path

    def __missing__(self, key):
        raise BadInput(f"{self.path}: no '{key}' (expected a file of this version of heel)")


def read_json(path):
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file, object_pairs_hook=lambda pairs: Numbers(path, pairs))
    except (OSError, ValueError) as error:
        raise BadInput(f"{path}: cannot read: {error} (expected a JSON file of heel)") from error
