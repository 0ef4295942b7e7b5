"""The README keeps its word: links lead somewhere, the keys are those of the program, every command in it works.

python3 tests/readme/test_readme.py --write puts the keys of the program into the README.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
README = ROOT / "README.md"
PROGRAM = Path(os.environ.get("PORESHOCK", ROOT / "build/release/poreshock"))
KEYS = re.compile(r"(?<=<!-- keys -->\n).*?(?=<!-- end of keys -->)", re.S)

# What a command of the README is called with here so that it ends soon; every other one runs as it stands.
SHORTENED = {
    "tools/run input/porous_aluminium.toml": ["--set", "time.end=10e-9"],
    "tools/run input/plate_impact.toml": ["--set", "time.end=50e-9"],
    "tools/test": ["-N"],
}


def keys_of_the_program():
    return subprocess.run([PROGRAM, "keys"], text=True, capture_output=True, check=True).stdout


def blocks(text, language=""):
    """The fenced blocks of a language."""
    fenced = re.findall(r"^```(\w*)\n(.*?)^```$", text, re.M | re.S)
    return [block for name, block in fenced if name == language]


def commands():
    """Every command in a fenced block, without its comment."""
    return [re.sub(r"\s+#.*", "", line) for block in blocks(README.read_text()) for line in block.splitlines() if line.strip()]


class Page(unittest.TestCase):
    text = README.read_text()

    def test_links_lead_somewhere(self):
        places = {re.sub(r"[^a-z0-9 -]", "", line.lower()).replace(" ", "-")
                  for line in re.findall(r"^#+ (.*)$", self.text, re.M)}
        links = re.findall(r"\]\(([^)]+)\)", self.text)
        self.assertGreater(len(links), 3)
        for link in links:
            if link.startswith("#"):
                self.assertIn(link[1:], places)
            else:
                self.assertTrue((ROOT / link).exists(), link)

    def test_files_it_names_are_there(self):
        for name in set(re.findall(r"`((?:tools|input|tests|src|jobscripts)/[\w./-]+)", self.text)):
            if not name.startswith("tests/paper/"):  # written by a command
                self.assertTrue((ROOT / name.rstrip("/")).exists(), name)

    def test_the_keys_are_those_of_the_program(self):
        self.assertEqual(KEYS.search(self.text).group(), keys_of_the_program(),
                         "run python3 tests/readme/test_readme.py --write")

    def test_the_picture_is_small(self):
        self.assertLess((ROOT / "tests/readme/porous_aluminium.png").stat().st_size, 300_000)


class Commands(unittest.TestCase):
    """In a copy of the sources, with the build of this one."""

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory(prefix="poreshock_readme_")
        cls.addClassCleanup(temporary.cleanup)
        cls.root = Path(temporary.name) / "poreshock"
        files = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout.decode().split("\0")
        for name in filter(None, files):
            (cls.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, cls.root / name)
        # Building is what tools/run and tools/test do before anything else; here it is done.
        (cls.root / "build").symlink_to(ROOT / "build")

    def call(self, command, *more):
        done = subprocess.run([*command.split(), *more], cwd=self.root, text=True, capture_output=True, check=False, timeout=600)
        self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout}\n{done.stderr}")
        return done.stdout

    def test_every_command(self):
        listed = commands()
        self.assertGreater(len(listed), 10)
        for command in listed:
            with self.subTest(command):
                longest = max((key for key in SHORTENED if command.startswith(key)), key=len, default=None)
                self.call(command, *SHORTENED.get(longest, []))

    def test_python(self):
        self.call("tools/run input/porous_aluminium.toml", "--set", "time.end=500e-9", "--set", "domain.size=[0.1e-3,0.6e-3]",
                  "--set", "sample.height=0.5e-3", "--set", "sample.void_radius=20e-6", "--output", "output/small")
        newest = sorted((self.root / "output/small").glob("snapshot_*.h5"))[5]
        for code in blocks(README.read_text(), "python"):
            name = re.search(r'"(output/[^"]*snapshot_[^"]*)"', code).group(1)
            done = subprocess.run([sys.executable, "-c", code.replace(name, str(newest))], cwd=self.root, text=True,
                                  capture_output=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertRegex(done.stdout, r"conserving\n\S+ K\n")

    def test_scenes_in_the_page(self):
        domain = '[domain]\nsize = [1e-4, 2e-4]\ncell = 1e-5\n[sample]\nkind = "solid"\n[time]\nend = 1e-8\n'
        for number, scene in enumerate(blocks(README.read_text(), "toml")):
            path = self.root / f"scene{number}.toml"
            path.write_text(domain + scene)
            self.call(f"{PROGRAM} check {path}")


if __name__ == "__main__":
    if sys.argv[1:] == ["--write"]:
        README.write_text(KEYS.sub(lambda _: keys_of_the_program(), README.read_text()))
    else:
        unittest.main()
