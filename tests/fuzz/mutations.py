# SPDX-License-Identifier: GPL-3.0-or-later
"""Changes to values, texts, scenes, formulas, tokens and bytes; `r` is always a seeded random.Random."""

import re

INTEGERS = [0, 1, -1, 2, 3, 4, 5, 15, 31, 32, 127, 128, 255, 256, 65535, 65536, 2**31 - 1, -2**31, 2**31, 2**32 - 1,
            2**32, 2**53, 2**63 - 1, 2**63, -2**63, 2**64 - 1, 2**64, 10**30]
REALS = [0., -0., 1., -1., 5e-324, 1e-308, 1e-300, 1e-160, 1e-78, 1e-16, 1e16, 1e78, 1e155, 1e160, 1e300, 1.7e308, -1e300,
         float("inf"), float("-inf"), float("nan")]
TEXTS = ["", " ", "\0", "\udcff\udcfe", "\udcc3", "é", "日本", "\x1b[31mred", "\x07", "\x7f", "A" * 300000, "%s%n%d", "..",
         "/", "/dev/null", "/dev/zero", "/proc/self/mem", "'", '"', '"a', ";", ";;", "|", ",", ",,", "#", "=", "\\", "\t", "\r",
         "a\nb", "nan", "inf", "-inf", "1e999", "1e-999", "0x10", "1,5", "1 2", "+1", "--1", "1e", ".", "1.", "true",
         "auto", "none", "-", "~", "$HOME", "*", "[1]", "{}", "<a>", "&amp;", "null", "x" * 5000 + "/y", "/" * 3000]
# Settings that would be obeyed for hours, or that need more memory than there is, are no faults: not asked for.
NUMBERS_OF = {
    "Time/Step": [5e-324, 1e-300, 1e-30, 1e-18, 0.01, 0.02, 0.03, 1., 1e30, 1e300, float("inf"), float("nan"), 0., -1.],
    "Time/End": [5e-324, 1e-300, 1e-30, 0.01, 0.03, 0.035, 1e30, 1e300, float("inf"), float("nan"), 0., -1.],
    "Time/Increments": [0, 1, 2, 3, -1, 2**31, 2**32, 1.5],
    "Mesh/Cells": [0, 9, 10, 11, 50, 50, -1, 2**31, 2**32, 1.5],
    "Mesh/Box cells": [0, 1, 1, 2, 2, -1, 2**31, 2**32, 1.5],
    "Solver/Maximum iterations": [0, 1, 2, 5, 50, -1, 2**31],
    "Repeats": [0, 1, -1, 2**31, 2**32, 1.5],
    "Threads": [0, 1, 2, -1, 1025, 2**31, 1.5],
}
SELECTIONS = ["boundary 1", "boundary 2", "region 1", "region 2", "region -1", "boundary 4294967296", "boundary 1.5", "box 0 0 0",
              "box 0 -1 -1 2 1 1", "sphere 0 0 0 1", "sphere 0 0 0 -1", "sphere 0 0 0 nan", "box nan 0 0 1 1 1",
              "box -1e400 -1 -1 0.1 1 1", "nodes held.txt", "nodes ", "nodes absent.txt", "nodes .", "nodes /dev/zero",
              "everything", "region 99999999999999999999", "boundary", "sphere 1e300 1e300 1e300 1e308"]
FORMULA_KEYS = {"Motion": (3, "xyzt"), "Force": (3, "t"), "Velocity": (3, "xyz"), "Pose functions": (3, "xyz"),
                "Pose function": (3, "xyz"), "Prescribed weights": (2, "t"), "Progress": (1, "t")}
FILES = ["mesh.msh", "pose.msh", "pose2.msh", "held.txt", "absent.msh", "mesh.geo", ".", "/dev/zero", "/dev/null", "scene.prm",
         "pose.msh,pose.msh", "mesh.msh/x"]
FUNCTIONS = ["sin", "cos", "tan", "sqrt", "exp", "log", "log2", "log10", "ln", "abs", "rint", "sign", "floor", "ceil", "asin",
             "acos", "atan", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh"]


def number(r):
    """A number as text: ordinary, extreme or not quite one."""
    choice = r.random()
    if choice < 0.25:
        return repr(r.choice(REALS))
    if choice < 0.4:
        return str(r.choice(INTEGERS))
    if choice < 0.7:
        return repr(r.choice([-1, 1, 1]) * 10.**r.uniform(-308, 308))
    return repr(round(r.uniform(-3, 3), 3))


def magnitude(r, allowed):
    """A number as text that the words allow: within its range, if it has one, or of any magnitude."""
    if match := re.search(r"in (\S+) \.\.\. (\S+)", allowed):
        low, high = map(float, match.groups())
        near = r.choice([0., 1e-300, 1e-16, 1e-9, 1e-3, 0.5]) * (high - low)
        return repr(r.choice([low + near, high - near]))
    reach = r.choice([3, 12, 40, 160, 308])
    return repr(r.choice([-1, 1, 1, 1] if ">" not in allowed else [1]) * 10.**r.uniform(-reach, reach))


def formula(r, variables, depth=0, tame=None):
    """A formula that muParser understands; a tame one is finite, too."""
    tame = r.random() < 0.6 if tame is None else tame
    choice = r.random()
    if depth > 3 or choice < 0.3:
        return r.choice([*variables, *variables, "pi", "0", "1", "2", "0.5"] + ([] if tame else ["1e300", "1e-300", number(r)]))
    a, b, c = (formula(r, variables, depth + 1, tame) for _ in range(3))
    if choice < 0.6:
        return f"({a}){r.choice('+-*' if tame else '+-*/^')}({b})"
    if choice < 0.8:
        return f"{r.choice(['sin', 'cos', 'abs', 'tanh', 'atan', 'exp'] if tame else FUNCTIONS)}({a})"
    if choice < 0.9:
        return f"{r.choice(['min', 'max', 'sum', 'avg', 'atan2'])}({a}, {b})"
    return f"(({a}){r.choice(['<', '>', '==', '!=', '<=', '&&', '||'])}({b}) ? ({c}) : ({a}))"


def spoilt_formula(r, variables):
    text = formula(r, variables)
    extra = r.choice(["(", ")", ",", "?", ":", ";", "=", "q", "_pi", "x", "1 1", "**", "!", "@", "t=1", "sin", "min()", "sin()",
                      "sin(1,2)", "\"a\"", "\0", "\udcff", "é", "0x", "1e", "..", "?:", "1?2", "1?2:", "^"])
    at = r.randrange(len(text) + 1)
    return r.choice([lambda: text[:at] + extra + text[at:], lambda: text[:at], lambda: text[at:],
                     lambda: "(" * 20000 + text + ")" * r.choice([20000, 19999]), lambda: "+".join([text] * 200),
                     lambda: "sin(" * 5000 + "1" + ")" * 5000, lambda: "-" * 30000 + "1", lambda: "1?" * 3000 + "1" + ":1" * 3000,
                     lambda: "2" + "^2" * 3000])()


def formulas(r, key):
    """A value of a key that takes formulas."""
    n, variables = FORMULA_KEYS[key]
    n = r.choice([n] * 30 + [n - 1, n + 1, 0])
    make = spoilt_formula if r.random() < 0.2 else formula
    poses = [r.choice(["; "] * 30 + [";", ", "]).join(make(r, variables) for _ in range(n))
             for _ in range(r.choice([1, 1, 2]) if key in ("Pose functions", "Prescribed weights") else 1)]
    return " | ".join(poses)


def value(r, key, allowed):
    """A value for "Section/Key", by the words that tell what is allowed: mostly of the right kind."""
    name = key.split("/")[-1]
    if r.random() < 0.05:
        return r.choice(TEXTS)
    if key in NUMBERS_OF or "number" in allowed or "integer" in allowed:
        pool = NUMBERS_OF.get(key)
        odd = r.random() < 0.3
        one = ((lambda: repr(r.choice(pool))) if pool else (lambda: number(r)) if odd
               else (lambda: str(r.choice(INTEGERS[:6]))) if "integer" in allowed else (lambda: magnitude(r, allowed)))
        n = r.choice([3, 3, 3, 3, 2, 4] if odd else [3]) if "three" in allowed else 1
        return ", ".join(one() for _ in range(n))
    if name in FORMULA_KEYS:
        return formulas(r, name)
    if name == "Select":
        return r.choice(SELECTIONS)
    if "file name" in allowed:
        return r.choice(FILES)
    if "true or false" in allowed:
        return r.choice(["true", "false"] * 4 + ["yes", "TRUE", "0", "maybe"])
    if name in ("Names", "Components"):
        return r.choice(["left", "left, left", "left, ", "x", "x, y", "x, x", "a/b", "left, b", "é", "\udcff", "region 1", ","])
    if name == "Directory":
        return r.choice(["out2", "a/b/c", ".", "..", "/", "/dev/null", "/proc/x", "scene.prm", "é", "n" * 300, " ", "a\tb",
                         "\udcff"])
    if name == "Weight penalty":
        return r.choice(["auto", "paper", "0", "nan", "inf", "-1", "1e308", "1e-320", number(r)])
    words = [word.strip() for word in allowed.split(",")]
    return r.choice(words * 4 + [words[0].upper(), ""])


# bytes

def damaged(r, data):
    """Bytes with flipped bits, other bytes, or parts removed, doubled or moved."""
    data = bytearray(data)
    for _ in range(r.choice([1, 1, 1, 2, 5, 30])):
        at = r.randrange(len(data) + 1)
        end = min(len(data), at + r.choice([1, 2, 4, 8, 30, 500]))
        action = r.randrange(7)
        if action == 0 and at < len(data):
            data[at] ^= 1 << r.randrange(8)
        elif action == 1:
            data[at:end] = bytes(r.randrange(256) for _ in range(end - at))
        elif action == 2:
            del data[at:end]
        elif action == 3:
            data[at:at] = data[at:end] * r.choice([1, 2, 50])
        elif action == 4:
            del data[at:]
        elif action == 5:
            data[at:end] = bytes([r.choice([0, 0xff, 0x7f, 0x80])]) * (end - at)
        elif action == 6:
            data[at:at] = r.choice(TEXTS).encode("utf-8", "surrogateescape")
    return bytes(data)


def spoilt_text(r, data):
    """Lines of a text changed as a hand or an editor would; otherwise its bytes."""
    if r.random() < 0.3:
        return damaged(r, data)
    lines = data.split(b"\n")
    for _ in range(r.choice([1, 1, 2, 4])):
        at, other = r.randrange(len(lines)), r.randrange(len(lines))
        action = r.randrange(11)
        if action == 0:
            lines.insert(at, lines[other])
        elif action == 1 and len(lines) > 1:
            del lines[at]
        elif action == 2:
            lines[at], lines[other] = lines[other], lines[at]
        elif action == 3:
            lines[at] += r.choice([b"\\", b"\r", b" # end", b"\0", b"\xff", b" " * 100000, b"=", b";"])
        elif action == 4:
            lines = [line + b"\r" for line in lines]
        elif action == 5:
            lines.insert(0, b"\xef\xbb\xbf")
        elif action == 6:
            lines[at] = damaged(r, lines[at])
        elif action == 7:
            line = r.choice([b"subsection a"] * 3 + [b"end", b"set", b"set a", b"set = 1", b"include x.prm", b"subsection"])
            lines[at:at] = [line] * r.choice([1, 1, 1, 20000])
        elif action == 8:
            lines[at] = lines[at].upper()
        elif action == 9:
            lines[at] = lines[at].replace(b" ", b"\t\t")
        elif action == 10:
            lines[at] = b" ".join(r.sample(words := lines[at].split(b" "), len(words)))
    return b"\n".join(lines)


def spoilt_tokens(r, tokens):
    """Tokens of a mesh file: other numbers, or some removed, doubled or exchanged."""
    tokens = list(tokens)
    numbers_only = r.random() < 0.4
    for _ in range(r.choice([1, 1, 1, 2, 4])):
        at = r.randrange(len(tokens)) if tokens else 0
        end = min(len(tokens), at + r.choice([1, 1, 2, 5, 8]))
        action = r.randrange(10)
        kind, old = tokens[at]
        if numbers_only:
            at = r.choice([i for i, (kind, _) in enumerate(tokens) if kind == "d"])
            tokens[at] = "d", r.choice([r.uniform(-3, 3), tokens[at][1] * r.choice([1.5, 1e3, 1e78, 1e154, 1e-300, -1]), 1e308])
        elif action == 0:
            del tokens[at:end]
        elif action == 1:
            tokens[at:at] = tokens[at:end] * r.choice([1, 1, 100])
        elif action == 2:
            other = r.randrange(len(tokens))
            tokens[at], tokens[other] = tokens[other], tokens[at]
        elif kind in "is":
            tokens[at] = kind, r.choice([r.choice(INTEGERS), old + r.choice([-1, 1]), r.randrange(40)])
        elif kind == "d":
            tokens[at] = kind, r.choice([r.choice(REALS), old * 10.**r.randrange(-200, 200), -old])
        elif kind == "t":
            tokens[at] = kind, r.choice([str(r.choice(INTEGERS)), r.choice(TEXTS), r.choice(tokens)[1] or "$End"])
    return tokens
