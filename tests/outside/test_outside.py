"""What cmake --install and cpack make: a program that runs, a package that an outside project uses, completion, a .deb."""
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("PORESHOCK_BUILD", ROOT / "build/release"))


def run(*command, cwd=None):
    done = subprocess.run([str(part) for part in command], cwd=cwd, text=True, capture_output=True, check=False, timeout=600)
    if done.returncode != 0:
        raise AssertionError(f"{command}: exit {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory(prefix="poreshock_install_")
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        cls.prefix = cls.folder / "prefix"
        run("cmake", "--install", BUILD, "--prefix", cls.prefix)
        cls.program = cls.prefix / "bin/poreshock"
        cls.scene = cls.prefix / "share/poreshock/input/plate_impact.toml"

    def mpirun(self, *command):
        return run(ROOT / "tools/mpirun", "-n", 2, *command, cwd=self.folder)

    def test_the_installed_program_runs_and_reports(self):
        self.mpirun(self.program, "run", self.scene, "--set", "time.end=50e-9", "--output", "plate")
        run("/usr/bin/python3", self.prefix / "share/poreshock/tools/report.py", self.folder / "plate")
        self.assertGreater((self.folder / "plate/report.html").stat().st_size, 10000)

    def test_an_outside_project_adds_a_material_and_reads_a_snapshot(self):
        build = self.folder / "outside"
        run("cmake", "-S", ROOT / "tests/outside/project", "-B", build, "-DCMAKE_BUILD_TYPE=Release",
            f"-DCMAKE_PREFIX_PATH={self.prefix}")
        run("cmake", "--build", build, "-j2")
        self.assertIn("ran with tantalum", self.mpirun(build / "add_material", self.folder / "short.toml", "tantalum"))
        file = self.folder / "tantalum/snapshot_000000.h5"
        text = self.mpirun(build / "read_snapshot", file)
        with h5py.File(file) as snapshot:
            self.assertIn("tantalum", snapshot.attrs["scene"])
            particles = snapshot["particles"]
            numpy.testing.assert_allclose(particles["density"][:], 16650.0)
            mean = numpy.average(particles["temperature"][:], weights=particles["mass"][:])
            self.assertIn(f"{particles['mass'].size} particles at 0 s, mean temperature {mean:.6g}", text)

    def setUp(self):
        text = self.scene.read_text()
        (self.folder / "short.toml").write_text(text)
        lines = [line for line in text.splitlines() if not line.startswith("end = ")]
        at = lines.index("[time]") + 1
        (self.folder / "short.toml").write_text("\n".join(lines[:at] + ["end = 20e-9", "max_steps = 20"] + lines[at:]) + "\n")

    def complete(self, *words):
        script = (f"source {self.prefix}/share/bash-completion/completions/poreshock; compopt() {{ :; }}; "
                  f"COMP_WORDS=({' '.join(repr(word) for word in (self.program.as_posix(), *words))}); "
                  f"COMP_CWORD={len(words)}; _poreshock; printf '%s\\n' \"${{COMPREPLY[@]}}\"")
        return run("bash", "-c", script).split()

    def test_completion(self):
        commands = run(self.program, "--help").split("Subcommands:")[1]
        for command in self.complete(""):
            if not command.startswith("-"):
                self.assertRegex(commands, rf"\n  {command} ")
        self.assertEqual(len(self.complete("")), 2 + len([line for line in commands.splitlines() if line.startswith("  ")]))
        self.assertEqual(self.complete("run", "--verb"), ["--verbose"])
        self.assertEqual(self.complete("run", "x.toml", "--set", "time.c"), ["time.cfl="])
        self.assertEqual(self.complete("run", "x.toml", "--set", "material.0.johnson_cook.m"), ["material.0.johnson_cook.melting="])
        self.assertEqual(self.complete("materials", "tu"), ["tungsten"])

    @unittest.skipUnless(shutil.which("dpkg-shlibdeps"), "there is no dpkg-shlibdeps (package dpkg-dev)")
    def test_debian_package(self):
        run("cpack", "-G", "DEB", "--config", BUILD / "CPackConfig.cmake", "-B", self.folder / "deb")
        package, = (self.folder / "deb").glob("poreshock_*.deb")
        depends = run("dpkg-deb", "--field", package, "Depends")
        for library in ("openmpi-bin", "libpetsc", "libhdf5-openmpi", "libpng", "libtiff", "libmetis"):
            self.assertIn(library, depends)
        root = self.folder / "root"
        run("dpkg-deb", "--extract", package, root)
        self.assertRegex(run(root / "usr/bin/poreshock", "--version"), r"^poreshock \d+\.\d+\.\d+ ")
        for path in ("share/poreshock/input/porous_aluminium.toml", "share/bash-completion/completions/poreshock",
                     "share/doc/poreshock/README.md", "share/doc/poreshock/input/README.md",
                     "include/poreshock/run/run.hpp"):
            self.assertTrue((root / "usr" / path).is_file(), path)


if __name__ == "__main__":
    unittest.main()
