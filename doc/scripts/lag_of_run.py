# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a live body would be behind the clock if its steps took the times of these runs, such as a recorded session that was played again.

Usage: python3 doc/scripts/lag_of_run.py OUTPUT...
Of several runs of one scene the least time of each step counts, so that other programs' share of the machine matters less. Printed: the
times of steps; how many steps factorise, and how often; and the share of steps, and of tenths of a second, that would end more than two
frames late: as it is, if single factors cost nothing (as on a thread), if none did, and if no step took more than 25 ms.
"""
import argparse
import csv
from collections import Counter
from pathlib import Path

FRAME = 1 / 60
MAX_DEBT = .1  # [s], which is not caught up: source/live/pace.cc
SENDING = .0005  # [s] a frame


def steps_of(output):
    with open(Path(output) / "statistics.csv", newline="") as file:
        return [{name: float(row[name] or 0) for name in ("iterations", "factorizations", "seconds_step", "seconds_assemble", "seconds_factorize")}
                for row in csv.DictReader(file)][1:]


def fastest(runs):
    return [min(alike, key=lambda step: step["seconds_step"]) for alike in zip(*runs)]


def lags(times):
    """[frames] at the end of each step."""
    due = now = 0.
    result = []
    for time in times:
        now = max(now, due) + time + SENDING
        due += FRAME
        result.append(max(0., (now - due) / FRAME))
        due = max(due, now - MAX_DEBT)
    return result


def told(times):
    late = [lag > 2 for lag in lags(times)]
    tenths = [any(late[i:i + 6]) for i in range(0, len(late), 6)]
    return f"{100 * sum(late) / len(late):.1f} % of steps, {100 * sum(tenths) / len(tenths):.1f} % of tenths; most {max(lags(times)):.1f} frames"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("outputs", nargs="+")
    steps = fastest([steps_of(output) for output in parser.parse_args().outputs])
    times = sorted(step["seconds_step"] for step in steps)
    factors = [step["seconds_assemble"] + step["seconds_factorize"] for step in steps]
    print(f"steps: {len(steps)}; median {1e3 * times[len(times) // 2]:.1f} ms, mean {1e3 * sum(times) / len(times):.1f} ms, "
          f"99 % {1e3 * times[int(.99 * len(times))]:.0f} ms, most {1e3 * times[-1]:.0f} ms; "
          f"{sum(step['iterations'] for step in steps) / len(steps):.1f} iterations in the mean")
    print("factors in a step: " + ", ".join(f"{n:.0f} in {count} steps" for n, count in sorted(Counter(s["factorizations"] for s in steps).items())))
    print("more than two frames late:")
    seconds = [step["seconds_step"] for step in steps]
    single = [s - (f if step["factorizations"] == 1 else 0) for s, f, step in zip(seconds, factors, steps)]
    for name, some in (("as it is", seconds), ("single factors for nothing", single),
                       ("all factors for nothing", [s - f for s, f in zip(seconds, factors)]), ("no step above 25 ms", [min(s, .025) for s in seconds])):
        print(f"  {name}: {told(some)}")


if __name__ == "__main__":
    main()
