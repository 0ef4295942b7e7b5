"""All pages keep their word: links, files, commands, generated parts, length, sentences; the manual holds them all.

python3 tests/readme/test_readme.py --write puts the keys of the program into input/README.md.
"""
import html
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from html.parser import HTMLParser
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("PORESHOCK", ROOT / "build/release/poreshock"))
KEYS_PAGE = ROOT / "input/README.md"
KEYS = re.compile(r"(?<=<!-- keys -->\n).*?(?=<!-- end of keys -->)", re.S)
# Pages that tools write whole.
GENERATED = {"tests/coverage.md", "tests/faults.md", "tests/hard_cases.md", "tests/paper/results.md",
             "tests/speed_vs_error/table.md", "tests/verification.md", "tests/verification/measured.md"}
# Every folder of which a reader may ask what it is.
FOLDERS = (".", "input", "input/first_hour", "src", "src/physics", "src/morphology", "src/output", "include/poreshock", "tests",
           "tests/verification", "tests/benchmark", "tools", "jobscripts")
# What a command is called with here so that it ends soon; every other one runs as it stands.
SHORTENED = {
    "tools/run input/porous_aluminium.toml": ["--set", "domain.size=[0.1e-3,0.6e-3]", "--set", "sample.height=0.5e-3",
                                              "--set", "sample.void_radius=20e-6", "--set", "sample.ligament=0",
                                              "--set", "domain.cell=5e-6", "--set", "time.end=255e-9"],
    "tools/run input/plate_impact.toml": ["--set", "time.end=50e-9"],
    "tools/run output/first_hour/voids.toml": ["--set", "domain.cell=10e-6"],
    "jobscripts/plain.sh": ["--set", "time.end=10e-9"],
    "tools/test": ["-N"],
    "tools/test --sanitizers": None,  # other builds
    "tools/test --all": None,
}


def pages():
    """Path below the top folder and text of every page."""
    names = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"], cwd=ROOT, text=True,
                           capture_output=True, check=True).stdout.split()
    return {name: (ROOT / name).read_text() for name in names}


def written(text):
    """The part of a page that people write."""
    return KEYS.sub("", text)


def keys_of_the_program():
    return subprocess.run([PROGRAM, "keys"], text=True, capture_output=True, check=True).stdout


def blocks(text):
    """Language and content of every fenced block, in order."""
    return re.findall(r"^```(\w*)\n(.*?)^```$", text, re.M | re.S)


def without_blocks(text):
    return re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)


def anchors(text):
    return {re.sub(r"[^a-z0-9 _-]", "", line.lower()).replace(" ", "-")
            for line in re.findall(r"^#+ (.*)$", without_blocks(text), re.M)}


def prose(text):
    """Paragraphs and items of lists, without code, formulas, tables and headings."""
    text = re.sub(r"\$\$.*?\$\$", "", without_blocks(text), flags=re.S)
    text = re.sub(r"^(\||#|<).*$", "", text, flags=re.M)
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", re.sub(r"`[^`]*`|\$[^$]*\$", "x", text))
    return [re.sub(r"\s+", " ", part) for part in re.split(r"\n\s*\n|\n\s*(?:- |\d+\. )", text) if part.strip()]


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.pages = pages()

    def test_every_folder_has_one(self):
        for folder in FOLDERS:
            self.assertIn((Path(folder) / "README.md").as_posix(), self.pages)

    def test_links_lead_somewhere(self):
        count = 0
        for name, text in self.pages.items():
            for link in re.findall(r"\]\(([^)\s]+)\)", without_blocks(text)):
                if re.match(r"[a-z]+:", link):
                    continue
                count += 1
                path, _, anchor = link.partition("#")
                target = (ROOT / name).parent / path if path else ROOT / name
                self.assertTrue(target.exists(), f"{name}: {link}")
                if anchor:
                    self.assertIn(anchor, anchors(target.read_text()), f"{name}: {link}")
        self.assertGreater(count, 50)

    def test_every_page_is_reached_from_the_first(self):
        reached, waiting = set(), ["README.md"]
        while waiting:
            name = waiting.pop()
            if name in reached:
                continue
            reached.add(name)
            for link in re.findall(r"\]\(([^)#\s]+\.md)", self.pages[name]):
                waiting.append(os.path.normpath(os.path.join(os.path.dirname(name), link)))
        self.assertEqual(reached, set(self.pages))

    def test_files_they_name_are_there(self):
        for name, text in self.pages.items():
            if name in GENERATED:
                continue
            for file in re.findall(r"`((?:tools|input|tests|src|include|jobscripts)/[\w./-]+)", text):
                self.assertTrue((ROOT / file).exists(), f"{name}: {file}")

    def test_the_keys_are_those_of_the_program(self):
        self.assertEqual(KEYS.search(KEYS_PAGE.read_text()).group(), keys_of_the_program(),
                         "run python3 tests/readme/test_readme.py --write")

    def test_they_are_short(self):
        for name, text in self.pages.items():
            if name not in GENERATED:
                lines = written(text).count("\n")
                self.assertLessEqual(lines, 150 if name == "README.md" else 350, name)

    def test_so_are_their_sentences(self):
        self.maxDiff = None
        long = [f"{name}: {sentence}" for name, text in self.pages.items() if name not in GENERATED
                for part in prose(written(text)) for sentence in re.split(r"(?<=[.!?:])\s+", part)
                if len(re.findall(r"\w[\w'.-]*", sentence)) > 25]
        self.assertEqual(long, [])

    def test_the_picture_is_small(self):
        self.assertLess((ROOT / "tests/readme/porous_aluminium.png").stat().st_size, 300_000)


class Commands(unittest.TestCase):
    """In a copy of the sources, with the build of this one. The blocks of a page follow each other."""

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

    def run_line(self, line):
        command, _, comment = line.partition("#")
        longest = max((key for key in SHORTENED if command.startswith(key)), key=len, default=None)
        more = SHORTENED[longest] if longest else []
        if more is None:
            return
        expected = re.search(r"exit code (\d)", comment)
        done = subprocess.run([*command.split(), *more], cwd=self.root, text=True, capture_output=True, check=False, timeout=900)
        self.assertEqual(done.returncode, int(expected.group(1)) if expected else 0, f"{line}\n{done.stdout}\n{done.stderr}")

    def run_python(self, code):
        done = subprocess.run([sys.executable, "-c", code], cwd=self.root, text=True, capture_output=True, check=False)
        self.assertEqual(done.returncode, 0, f"{code}\n{done.stderr}")
        return done.stdout

    def check_scene(self, text):
        """A part of a scene is checked with the least that makes it whole."""
        for table, least in (("[domain]", 'domain.size = [1e-4, 2e-4]\ndomain.cell = 1e-5\n'), ("[sample]", 'sample.kind = "solid"\n'),
                             ("[time]", "time.end = 1e-8\n"), ("[[material]]", 'material = [{ name = "copper" }]\n')):
            text = text if table in text else least + text
        (self.root / "output").mkdir(exist_ok=True)
        (self.root / "output/scene.toml").write_text(text)
        self.run_line(f"{PROGRAM} check output/scene.toml")

    def run_page(self, name):
        """What the Python of the page prints."""
        said = []
        for language, content in blocks((ROOT / name).read_text()):
            if language == "python":
                said.append(self.run_python(content))
            elif language == "toml":
                self.check_scene(content)
            elif not language:
                for line in filter(str.strip, content.splitlines()):
                    with self.subTest(line):
                        self.run_line(line)
        return said

    def test_readme(self):
        said, = self.run_page("README.md")
        self.assertRegex(said, r"conserving\n\S+ K\n")

    def test_first_hour(self):
        said = self.run_page("input/first_hour/README.md")
        self.assertEqual(len(re.findall(r"\d+ K: area 0\.\d+, hot spots \d+ at 200 ns", said[1])), 3)
        self.assertTrue((self.root / "output/first_hour/hot_spots.png").is_file())

    def test_the_other_pages(self):
        for name in sorted(set(pages()) - GENERATED - {"README.md", "input/first_hour/README.md"}):
            self.run_page(name)


class Reader(HTMLParser):
    """What a browser would follow or fetch, and where it could go."""

    def __init__(self, text):
        super().__init__()
        self.places, self.links, self.fetched, self.tags = set(), set(), [], {}
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.tags[tag] = self.tags.get(tag, 0) + 1
        self.places.add(attributes.get("id"))
        if tag == "a" and attributes.get("href", "").startswith("#"):
            self.links.add(attributes["href"][1:])
        elif tag != "a":
            self.fetched += [attributes[key] for key in ("src", "href") if key in attributes]


@unittest.skipUnless(shutil.which("pandoc"), "there is no pandoc to make the manual (tools/manual installs it)")
class Manual(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory(prefix="poreshock_manual_")
        cls.addClassCleanup(temporary.cleanup)
        cls.file = Path(temporary.name) / "manual.html"
        subprocess.run([ROOT / "tools/manual", cls.file], check=True, capture_output=True, timeout=200)
        cls.reader = Reader(cls.file.read_text())
        cls.text = html.unescape(cls.file.read_text())

    def test_it_holds_every_page(self):
        for name, text in pages().items():
            self.assertIn(name.replace("/", "-").replace(".", "-"), self.reader.places)
            self.assertTrue(re.search(r"^# (.*)$", text, re.M).group(1).split("`")[0] in self.text, name)

    def test_links_stay_inside_and_nothing_is_fetched(self):
        self.assertEqual(self.reader.links - self.reader.places, set())
        self.assertEqual([place for place in self.reader.fetched if not place.startswith("data:")], [])

    def test_formulas_are_rendered(self):
        count = sum(len(re.findall(r"\$\$.*?\$\$", without_blocks(text), re.S)) for text in pages().values())
        self.assertGreater(count, 10)
        self.assertGreaterEqual(self.reader.tags["math"], count)
        self.assertFalse("$$" in self.text)

    def test_search_finds_a_section(self):
        chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
        if not chromium:
            self.skipTest("there is no chromium to search the manual")
        word = ('<script>const field = document.querySelector("input"); field.value = "coulomb friction";'
                'field.dispatchEvent(new Event("input"));</script></body>')
        asked = self.file.with_name("asked.html")
        asked.write_text(self.file.read_text().replace("</body>", word))
        done = subprocess.run([chromium, "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom",
                               f"--user-data-dir={self.file.parent / 'browser'}", f"file://{asked}"], text=True,
                              capture_output=True, check=True, timeout=120)
        found = re.search(r'<div id="found">(.*?)</div>', done.stdout, re.S).group(1)
        self.assertIn('href="#src-physics-README-md--contact"', found)
        self.assertNotIn("0 sections", found)


if __name__ == "__main__":
    if sys.argv[1:] == ["--write"]:
        KEYS_PAGE.write_text(KEYS.sub(lambda _: keys_of_the_program(), KEYS_PAGE.read_text()))
    else:
        unittest.main()
