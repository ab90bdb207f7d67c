# SPDX-License-Identifier: GPL-3.0-or-later
"""Recorded sessions and directories of runs that no program has written so; `r` is a seeded random.Random."""

import base64
import re
import struct
import zlib

import mutations

HEAD = b"exemplar session 1\n"
EVENTS = ["1 | grab | a | 0 1 | 0.5 0 0 0 0.5 0 0 0 2 0 1 1000", "1 | move | a | | 2 0.1 1.2", "1 | release | a | |",
          "1 | hold | h | 2 3 | 0 0 0 0 0 0", "1 | shift | h | | 0 0.01 0", "1 | let go | h | |", "1 | young | | | 2e6", "1 | poisson | | | 0.3",
          "1 | density | | | 900", "1 | importance | | | 0.5", "1 | weights | | | 0.5 0.5", "1 | weights | | |", "1 | gravity | | | 0 0 -9.81",
          "1 | damping | | | 1 0.001", "1 | forget | | |"]


def spoilt_event(r, line):
    fields = line.split(" | ") + [""] * (5 - len(line.split(" | ")))
    at = r.randrange(5)
    action = r.random()
    if action < 0.3:
        fields[at] = r.choice([mutations.number(r), str(r.choice(mutations.INTEGERS)), r.choice(mutations.TEXTS)[:2000]])
    elif action < 0.6:
        words = fields[4].split() or ["0"]
        words[r.randrange(len(words))] = mutations.number(r)
        fields[4] = " ".join(words)
    elif action < 0.7:
        del fields[at]
    elif action < 0.8:
        fields[3] = " ".join(str(r.choice([0, 1, 2, 11, 12, *mutations.INTEGERS])) for _ in range(r.randrange(5)))
    elif action < 0.9:
        fields[1] = r.choice(["grab", "move", "release", "hold", "shift", "let go", "young", "weights", "fly", ""])
    else:
        fields[2] = r.choice(["a", "h", "left", "b", "", " ", "a" * 300, "\x1b[1m"])
    return " | ".join(fields)


def session(r):
    """The bytes of a session file; some are right."""
    lines, step = [], 1
    for _ in range(r.choice([1, 2, 5, 10])):
        step += r.choice([0, 0, 1])
        line = r.choice(EVENTS).replace("1 |", f"{step} |", 1)
        lines.append(spoilt_event(r, line) if r.random() < 0.4 else line)
    data = HEAD + "".join(line + "\n" for line in lines).encode("utf-8", "surrogateescape")
    action = r.random()
    if action < 0.1:
        return mutations.damaged(r, data)
    return data[:r.randrange(len(data))] if action < 0.2 else data


def _spoilt_numbers(r, data):
    """The bytes of an array with some of them changed."""
    data = bytearray(data)
    for _ in range(r.choice([1, 1, 3])):
        if not data:
            break
        at = r.randrange(len(data)) // 4 * 4
        word = r.choice([struct.pack("<i", r.choice([-1, 0, 2**31 - 1, -2**31, 7, 0x55555556])), struct.pack("<d", r.choice(mutations.REALS)), bytes(4)])
        data[at:at + len(word)] = word
    return r.choice([bytes(data), bytes(data), bytes(data), b"", bytes(len(data)), bytes(data) + bytes(4), bytes(data[:len(data) // 2])])


def spoilt_frame(r, data):
    """A frame with other numbers in an array that is whole, with a size that is a lie, or with other bytes."""
    names = list(re.finditer(rb' Name="\w+"[^>]*>([^<]{44,})<', data))
    if not names or r.random() < 0.3:
        return mutations.damaged(r, data)
    begin, end = r.choice(names[:3] * 3 + names).span(1)
    try:
        numbers = zlib.decompress(base64.b64decode(data[begin + 44:end]))
    except (ValueError, zlib.error):
        return mutations.damaged(r, data)
    changed = _spoilt_numbers(r, numbers)
    packed = zlib.compress(changed)
    size = len(changed) if r.random() < 0.8 else r.choice([0, 1, 2**31, 2**32, 2**63, 2**64 - 1])
    return data[:begin] + base64.b64encode(struct.pack("<4Q", 1, size, size, len(packed))) + base64.b64encode(packed) + data[end:]
