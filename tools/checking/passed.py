"""Remembers which units passed a check, so that only what changed is checked again.

For each unit the contents of all files of the tree that it reads are kept as hashes, in $XDG_CACHE_HOME/heel (~/.cache/heel).
Its command, the settings of the check and the versions of compiler and installed headers are in the name of the entry. A unit
with findings is never kept.
"""
import functools
import hashlib
import json
import os
import pathlib
import subprocess

from checking.units import ROOT


def digest(*parts):
    return hashlib.sha256(b"\0".join(part.replace(str(ROOT).encode(), b"") for part in parts)).hexdigest()


@functools.cache
def file_digest(path):
    """Of a file below the tree; the tree's own path is left out, so that another checkout has the same."""
    try:
        return digest((ROOT / path).read_bytes())
    except OSError:
        return None


def output_of(*command):
    return subprocess.run(command, capture_output=True, check=True).stdout


class Passed:
    def __init__(self, check, *settings):
        """`settings`: bytes that, when they change, make every unit be checked again."""
        cache = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache")
        self.folder = cache / "heel" / check
        headers = output_of("dpkg-query", "--show", "*-dev")  # with versions; system headers are not looked at one by one
        self.settings = digest(headers, *settings)

    def _entry(self, unit):
        return self.folder / digest(self.settings.encode(), str(unit.place()).encode(), " ".join(unit.command).encode())

    def has(self, unit):
        try:
            files = json.loads(self._entry(unit).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return False
        return all(file_digest(path) == kept for path, kept in files.items())

    def keep(self, unit, t_begin_s):
        """After a check that began at `t_begin_s` (time.time()); nothing is kept when a file has changed since."""
        done = subprocess.run([*unit.command, "-MM", str(unit.source)], cwd=unit.build, check=True, capture_output=True, text=True)
        read = [unit.build / word for word in done.stdout.partition(":")[2].replace("\\\n", " ").split()]
        files = [os.path.relpath(path, ROOT) for path in map(os.path.realpath, read) if path.startswith(f"{ROOT}/")]
        if any((ROOT / file).stat().st_mtime >= t_begin_s for file in files):
            return
        self.folder.mkdir(parents=True, exist_ok=True)
        entry = self._entry(unit)
        new = entry.with_suffix(f".{os.getpid()}")
        new.write_text(json.dumps({file: file_digest(file) for file in sorted(set(files))}), encoding="utf-8")
        new.replace(entry)
