"""`heel simulate` with sampled poses, as random-worlds, compare-laws and sweep-laws run it: one law, one scenario, its figures."""
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MODEL = ROOT / "tools/heel-sim/pose_noise/pictured.toml"


def add_options(parser, laws, runs):
    """Those that the three programs share; `laws` and `runs` are the defaults."""
    parser.add_argument("--laws", default=laws, type=lambda names: names.split(","))
    parser.add_argument("--runs", type=int, default=runs)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--heel", type=pathlib.Path, default=ROOT / "build/release/bin/heel")


def simulate(heel, scenario, law, *arguments, control=()):
    """What heel simulate --json answers. `control`: lines of the section [control]; `arguments`: further ones of the command."""
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as config:
        config.write("\n".join(["[control]", f'law = "{law}"', *control, ""]))
        config.flush()
        command = [str(part) for part in (heel, "simulate", scenario, "--error-model", MODEL, "--config", config.name, "--json",
                                          *arguments)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def simulate_runs(options, scenario, law, control=()):
    """The same over options.runs runs from options.seed on: for each figure its mean, median, least and greatest value."""
    if options.runs < 2:
        sys.exit(f"--runs {options.runs}: expected 2 or more, because median and worst run are compared")
    return simulate(options.heel, scenario, law, "--runs", options.runs, "--seed", options.seed, control=control)
