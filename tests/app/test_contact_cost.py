"""A scene without grains pays nothing for contact: instructions under callgrind, counted, not timed."""
import os
import re
import shutil
import subprocess
import unittest
from pathlib import Path

from program import PATIENCE, PROGRAM, ROOT, ProgramTest

# valgrind must know its instructions.
COUNTED = Path(os.environ.get("PORESHOCK_COUNTED", PROGRAM))
# Source files of which everything is there for contact.
CONTACT_FILES = ["contact", "grain_contact", "self_contact", "gap", "parting_plane", "node_points", "facing",
                 "surfaces", "grain_fields", "facing_fields", "grain_colours"]
SHARE = 0.005
STEPS = 6


def contact_functions():
    """Names of all functions of ours that the object files of contact define and no others."""
    contact, others = set(), set()
    for file in COUNTED.parent.glob("CMakeFiles/poreshock_*.dir/src/*/*.cpp.o"):
        listing = subprocess.run(["nm", "--demangle", "--defined-only", file], capture_output=True, text=True,
                                 check=True).stdout
        names = contact if file.name.removesuffix(".cpp.o") in CONTACT_FILES else others
        for line in listing.splitlines():
            _, kind, symbol = line.split(maxsplit=2)
            if kind in "tTW":
                names.add(function_name(symbol))
    return {name for name in contact - others if name.startswith("poreshock::")}


def function_name(text):
    """A function without file, result, template and other arguments."""
    text = text.replace("(anonymous namespace)::", "")
    kept, depth = "", 0
    for letter in text:
        if letter == "<":
            depth += 1
        elif letter == ">":
            depth -= 1
        elif depth == 0 and letter == "(":
            break
        elif depth == 0:
            kept += letter
    return kept.split()[-1][max(kept.split()[-1].find("poreshock::"), 0):] if kept.split() else ""


class ContactCost(ProgramTest):
    @unittest.skipUnless(shutil.which("valgrind"), "needs valgrind, which is not installed")
    def test_none_without_grains(self):
        self.assertTrue(COUNTED.exists(), f"{COUNTED} is missing: the build target slow_tests makes it")
        counts = self.folder / "callgrind"
        subprocess.run(
            ["valgrind", "--tool=callgrind", f"--callgrind-out-file={counts}", "--toggle-collect=void poreshock::advance<*",
             COUNTED, "run", ROOT / "input/porous_aluminium.toml", "--output", "out", "--set",
             "domain.size=[0.16e-3, 0.36e-3]", "sample.height=0.3e-3", f"time.max_steps={STEPS}"],
            cwd=self.folder, check=True, capture_output=True, timeout=500 * PATIENCE)
        listing = subprocess.run(["callgrind_annotate", "--inclusive=yes", "--threshold=100", counts],
                                 capture_output=True, text=True, check=True).stdout
        costs = {}
        for line in listing.splitlines():
            found = re.match(r"\s*([\d,]+) \(\s*[\d.]+%\)\s+(\S.*)$", line)
            if found and "poreshock::" in line:
                name = function_name(found[2])
                costs[name] = costs.get(name, 0) + int(found[1].replace(",", ""))
        whole = costs["poreshock::advance"]
        self.assertGreater(whole, STEPS * 1e6)
        known = contact_functions()
        self.assertIn("poreshock::collide", known)
        # With all they call; what they call among themselves counts twice, on the safe side.
        spent = {name: cost for name, cost in costs.items() if name in known}
        self.assertIn("poreshock::collide", spent)
        share = sum(spent.values()) / whole
        print(f"contact takes {100 * share:.4f} % of {whole} instructions: {spent}")
        self.assertLess(share, SHARE)


if __name__ == "__main__":
    unittest.main()
