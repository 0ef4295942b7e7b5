"""The report in a browser: headless Chromium runs its script, at the width of a phone nothing sticks out, and it is not blank."""
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import matplotlib.image
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from fake_output import write_output  # noqa: E402
from poreshock_report import comparison, page  # noqa: E402

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
FRAME = """<!DOCTYPE html><iframe id="f" src="PAGE" style="width:390px;height:800px;border:0"></iframe>
<script>document.getElementById("f").onload = function (event) {
  document.title = "width " + event.target.contentDocument.documentElement.scrollWidth; };</script>"""


@unittest.skipUnless(CHROMIUM, "there is no chromium to draw the page")
class Browser(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name) / "run"
        write_output(cls.folder)
        page.write(cls.folder)
        write_output(cls.folder.parent / "other")
        comparison.write(cls.folder.parent / "other", cls.folder)

    def chromium(self, name, *options):
        command = [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--allow-file-access-from-files",
                   f"--user-data-dir={self.folder / 'browser'}", *options, f"file://{self.folder / name}"]
        return subprocess.run(command, text=True, capture_output=True, check=True, timeout=120).stdout

    def test_the_slider_shows_one_frame(self):
        text = self.chromium("report.html", "--dump-dom")
        self.assertRegex(text, r'<input type="range"[^>]*max="4"')
        frames = re.findall(r'<figure data-time="([^"]*)"( class="[^"]*")?', text)
        self.assertEqual([time for time, hidden in frames if "hidden" not in hidden], ["200 ns"])
        self.assertEqual(len(frames), 5)

    def test_nothing_sticks_out_of_a_phone(self):
        for name in ("report.html", "compared_with_other.html"):
            (self.folder / "phone.html").write_text(FRAME.replace("PAGE", name))
            text = self.chromium("phone.html", "--dump-dom", "--virtual-time-budget=5000")
            self.assertIn("<title>width 390</title>", text, name)

    def measured_on_a_phone(self, expression):
        """Numbers that a JavaScript expression gives for the document `page`."""
        (self.folder / "phone.html").write_text(FRAME.replace("PAGE", "report.html").replace(
            '"width " + event', f'"found " + (function (page) {{ return {expression}; }})(event.target.contentDocument); event'))
        text = self.chromium("phone.html", "--dump-dom", "--virtual-time-budget=5000")
        return [float(entry) for entry in re.search("<title>found (.*?)</title>", text)[1].split(",")]

    def test_a_phone_shows_the_summary_first(self):
        tops = self.measured_on_a_phone("""["table", ".warning, .fine", "#movie"].map(function (name) {
            return page.querySelector("#summary " + name).getBoundingClientRect().top; })""")
        self.assertEqual(tops, sorted(tops))
        self.assertLess(tops[0], 400)  # pixels: the figures of the shock are on the first screen

    def test_the_summary_needs_no_moving_sideways_on_a_phone(self):
        beyond = self.measured_on_a_phone("""[...page.querySelectorAll("#summary .scroll")].map(function (box) {
            return box.scrollWidth - box.clientWidth; })""")
        self.assertEqual(beyond, [0.0, 0.0])

    def test_letters_of_pictures_can_be_read_on_a_phone(self):
        # Ten points at 64 pixels an inch, however wide the picture.
        scale = self.measured_on_a_phone("""[...page.querySelectorAll(".picture img")].map(function (image) {
            return image.clientWidth / image.naturalWidth * 150; })""")
        self.assertEqual(len(scale), 8)
        self.assertGreater(min(scale), 55.0)

    def test_the_page_is_drawn(self):
        self.chromium("report.html", "--window-size=800,3000", f"--screenshot={self.folder / 'page.png'}")
        shot = matplotlib.image.imread(self.folder / "page.png")[:, :, :3]
        self.assertEqual(shot.shape[:2], (3000, 800))
        # Text and curves all the way down: no stretch of 600 rows is white throughout.
        dark = (shot.min(axis=2) < 0.8).any(axis=1)
        self.assertLess(int(numpy.diff(numpy.flatnonzero(numpy.concatenate([[True], dark, [True]]))).max()), 600)


if __name__ == "__main__":
    unittest.main()
