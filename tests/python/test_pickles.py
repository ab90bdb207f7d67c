# SPDX-License-Identifier: GPL-3.0-or-later
"""Pickles of states: by all protocols; and damaged ones, which are refused by one message, or by pickle itself."""
import copy
import hashlib
import pickle
import random
import resource
import signal
import subprocess
import sys
import unittest
from collections import Counter

import exemplar
from test_state import KINDS

N_MUTATIONS = 2000
# what no message may say, of what pickle lets through to exemplar
RAW = r"incompatible function arguments|Unable to cast|archive|std::|vector|basic_string|bad_alloc|registered"


def state_of(kind):
    problem = exemplar.Problem(KINDS[kind])
    for _ in range(3):
        problem.step()
    return problem.state


def sealed(content):
    return content + b"\n$SHA256\n" + hashlib.sha256(content).hexdigest().encode() + b"\n$EndSHA256\n"


def mutated(content, by):
    """Another one: flips of bits, other bytes, and parts that are cut, doubled, moved or left out."""
    place, other, length = by.randrange(len(content)), by.randrange(len(content)), by.choice((1, 4, 8, 100))
    changed = bytearray(content)
    kind = by.randrange(6)
    if kind < 2:
        changed[place] ^= 1 << by.randrange(8)
    elif kind == 2:
        changed[place:place + length] = by.randbytes(len(changed[place:place + length]))
    elif kind == 3:
        del changed[place:place + length]
    elif kind == 4:
        changed[place:place] = changed[other:other + length]
    else:
        del changed[place:]
    return bytes(changed)


def unpickle_mutations(n):
    """Load damaged pickles, and damaged states; count what came of it. To be called in a process of its own."""
    import re
    resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))  # a damaged length may ask for any
    by, found = random.Random(1), Counter()
    states = [state_of(kind) for kind in ("bdf2", "plastic")]
    for number in range(n):
        state = states[number % 2]
        whole = state.__reduce__()[2] if number % 3 == 0 else pickle.dumps(state, protocol=number % 6)
        changed = mutated(whole, by)
        signal.alarm(20)
        try:
            if number % 3 == 0:
                loaded = exemplar.State.__new__(exemplar.State)
                loaded.__setstate__(changed)
            else:
                loaded = pickle.loads(changed)
            # without its last bytes a stream may be of a part of it, which pickle then gives
            kind = "same" if loaded == state else f"another: {number}" if isinstance(loaded, exemplar.State) else "no state"
            found[kind] += 1
        except exemplar.UserError as error:
            found["refused" if re.match("The pickle of an exemplar.State is damaged", str(error)) else f"odd: {error}"] += 1
        except Exception as error:
            is_raw = number % 3 == 0 or re.search(RAW, str(error))  # of a state alone pickle says nothing
            found[f"raw: {number} {error!r:.200}" if is_raw else "refused by pickle"] += 1
    signal.alarm(0)
    return found


class Pickles(unittest.TestCase):
    def test_all_protocols(self):
        state = state_of("bdf2")
        for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
            with self.subTest(protocol):
                self.assertEqual(pickle.loads(pickle.dumps(state, protocol)), state)

    def test_what_cannot_be_pickled_says_so(self):
        problem = exemplar.Problem(KINDS["newton"])
        with problem.record() as trajectory:
            report = problem.step()
        for one in problem, report, trajectory:
            for call in (copy.copy, copy.deepcopy, *(lambda object, to=to: pickle.dumps(object, to) for to in range(6)), lambda object: object.__reduce__()):
                with self.assertRaisesRegex(TypeError, f"cannot pickle an exemplar.{type(one).__name__}. (Pickle|Keep) its"):
                    call(one)

    def test_other_contents_are_refused(self):
        state = exemplar.Problem(KINDS["static"]).state
        kept = state.__reduce__()[2]
        content = kept[:kept.rindex(b"\n$SHA256")]
        self.assertEqual(sealed(content), kept)
        version = exemplar.__version__.encode()
        for words, given in (("damaged, or of an earlier exemplar", (exemplar.__version__, b"22 serialization::archive")), ("damaged", kept[:99]),
                             ("damaged", None), ("damaged", "text"), ("damaged", b""), ("damaged", kept.replace(b"\0", b"\1", 1)),
                             ("pickled by exemplar 99, but this is", sealed(content.replace(version, b"99", 1))),
                             ("another build", sealed(content[:200]))):
            with self.subTest(words), self.assertRaisesRegex(exemplar.UserError, words):
                exemplar.State.__new__(exemplar.State).__setstate__(given)

    def test_damaged_pickles(self):
        done = subprocess.run([sys.executable, __file__, "--mutations", str(N_MUTATIONS)], capture_output=True, text=True, timeout=600)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        found = Counter(dict(line.rsplit(" = ", 1) for line in done.stdout.splitlines()))
        self.assertLessEqual(set(found), {"same", "no state", "refused", "refused by pickle"})
        self.assertEqual(sum(map(int, found.values())), N_MUTATIONS)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--mutations"]:
        for outcome, number in sorted(unpickle_mutations(int(sys.argv[2])).items()):
            print(f"{outcome} = {number}")
    else:
        unittest.main()
