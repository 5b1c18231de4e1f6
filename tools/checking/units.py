"""What the compiler reads at once, as a preset's compile_commands.json has it: a source, or sources that the preset joins."""
import functools
import json
import pathlib
import re
import shlex
import subprocess
from dataclasses import dataclass

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


@dataclass(frozen=True)
class Unit:
    source: pathlib.Path
    build: pathlib.Path  # the preset's folder, in which the command runs
    command: tuple  # compiler and flags; neither what to make nor where

    def place(self):
        """The source's path below the tree, or below the preset's folder."""
        return self.source.relative_to(self.build if self.source.is_relative_to(self.build) else ROOT)

    def search_folders(self):
        return tuple(pathlib.Path(flag[2:]) for flag in self.command if flag.startswith("-I"))


def configure(preset):
    subprocess.run(["cmake", "--preset", preset], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    return ROOT / "build" / preset


def units_of(build, folders):
    """Those below these folders of the tree; a source that several targets have counts once."""
    found = {}
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        words = shlex.split(entry["command"])
        compiler = next(i for i, word in enumerate(words) if re.fullmatch(r"(.*/)?(c\+\+|g\+\+|clang\+\+)(-\d+)?", word))
        flags = words[compiler:words.index("-o")]  # CMake puts "-o OBJECT -c SOURCE" last
        unit = Unit(pathlib.Path(entry["file"]), build, tuple(flags))
        if unit.place().parts[0] in folders:
            found.setdefault(unit.source, unit)
    return list(found.values())


@functools.cache
def included_files(source, folders):
    """The files of the tree that `source` includes in quotes; `folders` are searched after its own."""
    names = INCLUDE.findall(source.read_text(encoding="utf-8"))
    candidates = ([folder / name for folder in (source.parent, *folders)] for name in names)
    return [next(path for path in paths if path.exists()) for paths in candidates if any(path.exists() for path in paths)]


def unit_that_reads(path, units):
    """That of the source `path`; for a header, of a source that includes it directly, its own before others. None: no such."""
    reading = [unit for unit in units if path == unit.source or path in included_files(unit.source, unit.search_folders())]
    return min(reading, key=lambda unit: (unit.source != path, unit.source.stem != path.stem), default=None)


def change_times():
    """path below the tree → when it was committed last; not yet: later than all."""
    times, time = {}, 0
    log = subprocess.run(["git", "log", "--format=@%ct", "--name-only"], cwd=ROOT, check=True, capture_output=True, text=True)
    for line in log.stdout.splitlines():
        if line.startswith("@"):
            time = int(line[1:])
        elif line:
            times.setdefault(line, time)
    for command in (["diff", "--name-only", "HEAD"], ["ls-files", "--others", "--exclude-standard"]):
        done = subprocess.run(["git", *command], cwd=ROOT, check=True, capture_output=True, text=True)
        times.update({name: float("inf") for name in done.stdout.splitlines()})
    return times


def newest_first(units):
    """Ordered by the last change to a source or to a header that it includes directly."""
    times = change_times()

    def changed(unit):
        folders = unit.search_folders()
        sources = [unit.source] if unit.source.is_relative_to(ROOT) and not unit.source.is_relative_to(unit.build) else \
            included_files(unit.source, folders)
        files = [file for source in sources for file in (source, *included_files(source, folders))]
        return max((times.get(str(file.relative_to(ROOT)), 0) for file in files if file.is_relative_to(ROOT)), default=0)

    return sorted(units, key=changed, reverse=True)
