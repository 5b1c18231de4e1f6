"""What tools/soak prints, and its verdict."""


def clock(seconds):
    return f"{int(seconds) // 60}:{int(seconds) % 60:02d}"


def ok(outcome):
    return outcome["as_stated"] and outcome["follows_again_s"] is not None


def result_of(outcome):
    if outcome["follows_again_s"] is None:
        return "NOT FOLLOWING AGAIN"
    if not outcome["as_stated"]:
        return "NOT AS STATED"
    return f"follows after {outcome['follows_again_s']:.1f} s"


def print_progress(now_s, end_s, outcome):
    left_s = max(0.0, end_s - now_s)
    said = ", ".join(outcome["reasons"]) or "drives on"
    print(f"{clock(now_s):>6}, {clock(left_s)} left: {outcome['fault']}: {said}; {result_of(outcome)}", flush=True)


def passed(soak):
    return (soak["heeld_status"] == 0 and soak["problem"] is None and soak["moved_at_rest"] == 0 and len(soak["outcomes"]) > 0
            and all(map(ok, soak["outcomes"]))
            and not any(quantity.get("grown", False) for quantity in soak["growth"].values()))


def fault_rows(soak):
    for name in dict.fromkeys(outcome["fault"] for outcome in soak["outcomes"]):
        outcomes = [outcome for outcome in soak["outcomes"] if outcome["fault"] == name]
        reasons = dict.fromkeys(reason for outcome in outcomes for reason in outcome["reasons"])
        again = [outcome["follows_again_s"] for outcome in outcomes if outcome["follows_again_s"] is not None]
        longest = f"{max(again):.1f} s" if len(again) == len(outcomes) else "never"
        yield name, len(outcomes), ", ".join(reasons) or "drives on", sum(map(ok, outcomes)), longest


def growth_rows(soak):
    for name, quantity in soak["growth"].items():
        if not quantity["judged"]:
            yield name, "-", "-", "-", f"not judged: {quantity['samples']} quiet samples of {quantity['needed']}"
            continue
        numbers = (f"{quantity[key]:.4g}" for key in ("first", "last", "limit"))
        yield name, *numbers, "GROWN" if quantity["grown"] else "no"


def markdown(heads, rows):
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def table(soak):
    parts = [
        markdown(["fault", "times", "heeld at rest for", "as stated", "follows again within"], fault_rows(soak)),
        markdown(["quantity", "after the first round", "at the end", "limit", "grown"], growth_rows(soak)),
        f"heeld ended with status {soak['heeld_status']}; stops without a fault: {soak['stops_without_a_fault']}; "
        f"commands that move a robot at rest: {soak['moved_at_rest']}; this program was held up by the machine for at most "
        f"{soak['held_up_s']:.1f} s",
    ]
    if soak["latency"] is not None:
        parts.append("from a frame that heeld has to the last byte of its command: median {p50_ms:.1f} ms, 99th percentile "
                     "{p99_ms:.1f} ms, longest {max_ms:.1f} ms".format(**soak["latency"]))
    if soak["left_out"]:
        parts.append("left out, because no file system can be mounted here: " + ", ".join(soak["left_out"]))
    if soak["problem"] is not None:
        parts.append(soak["problem"])
    return "\n\n".join([*parts, "passed" if soak["passed"] else "NOT PASSED"])
