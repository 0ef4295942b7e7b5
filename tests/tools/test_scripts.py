"""The shell scripts around a run, with a small program in the place of mpirun and of poreshock."""
import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SOURCED = ("resubmit.sh",)
SCRIPTS = [*(path for path in (ROOT / "jobscripts").glob("*.sh") if path.name not in SOURCED), ROOT / ".ci/run", ROOT / ".ci/nightly",
           *(ROOT / "tools" / name for name in ("build", "cores", "install", "lint", "mpirun", "run", "test"))]
SCRIPT_NAMES = [path.relative_to(ROOT).as_posix() for path in SCRIPTS]

# Counts USR1 like the ranks of a run: each is noted, and the first ends it a moment later.
PROGRAM = """import os, signal, sys, time
seen = []
signal.signal(signal.SIGUSR1, lambda *_: seen.append(1))
print("ready", flush=True)
end = time.time() + 20
while time.time() < end and not seen:
    time.sleep(0.01)
time.sleep(0.3)
print("USR1", len(seen), flush=True)
sys.exit(int(sys.argv[1]))
"""


class Signals(unittest.TestCase):
    def stop(self, number, code):
        """Output and exit code of a shell that is sent the signal twice while its program runs."""
        with tempfile.TemporaryDirectory() as name:
            program = Path(name) / "program.py"
            program.write_text(PROGRAM)
            script = (f'set -euo pipefail; source {ROOT}/tools/stop_with_checkpoint.sh; status=0; '
                      f'run_with_checkpoint /usr/bin/python3 {program} {code} || status=$?; '
                      'echo "stopped $stopped"; exit $status')
            shell = subprocess.Popen(["bash", "-c", script], stdout=subprocess.PIPE, text=True,
                                     stderr=subprocess.DEVNULL, start_new_session=True)
            self.assertEqual(shell.stdout.readline(), "ready\n")
            for _ in range(2):
                os.killpg(shell.pid, number)  # as Ctrl-C does: to the whole group
                time.sleep(0.1)
            output = shell.communicate(timeout=30)[0]
            return output.split("\n")[:2], shell.returncode

    def test_a_signal_becomes_one_usr1_and_the_exit_code_is_kept(self):
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGXCPU, signal.SIGUSR1, signal.SIGUSR2):
            for code in (0, 3):
                self.assertEqual(self.stop(number, code), (["USR1 1", "stopped 1"], code))

    def test_without_a_signal_the_exit_code_is_kept(self):
        script = (f'set -euo pipefail; source {ROOT}/tools/stop_with_checkpoint.sh; '
                  'run_with_checkpoint bash -c "exit 4" || echo "$? $stopped"')
        done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True)
        self.assertEqual(done.stdout, "4 0\n")


class Commands(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.root = Path(self.temporary.name) / "poreshock"
        self.bin = self.root / "bin"
        self.bin.mkdir(parents=True)

    def script(self, path, text):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("#!/usr/bin/env bash\n" + text)
        path.chmod(0o755)

    def call(self, *command, **environment):
        return subprocess.run([str(part) for part in command], cwd=self.root, capture_output=True, text=True,
                              check=False, env=os.environ | {"PATH": f"{self.bin}:{os.environ['PATH']}"}
                              | environment)

    def test_scripts_are_executable_and_strict(self):
        for path in SCRIPTS:
            self.assertTrue(os.access(path, os.X_OK), path)
            self.assertIn("\nset -euo pipefail\n", path.read_text(), path)

    def options(self, ranks, **environment):
        """Options tools/mpirun gives to mpirun on a machine with two cores."""
        self.script(self.bin / "mpirun", 'echo "$OMP_NUM_THREADS $*"\nexit 5\n')
        self.script(self.bin / "nproc", "echo 2\n")
        self.script(self.bin / "lscpu", "printf '0,0\\n1,0\\n'\n")
        self.script(self.bin / "id", "echo 1000\n")
        clean = {"SLURM_JOB_ID": "", "PBS_NODEFILE": ""} | environment
        done = self.call(ROOT / "tools/mpirun", "-n", ranks, "program", "a b", **clean)
        self.assertEqual(done.returncode, 5)
        return done.stdout.strip()

    def test_mpirun_options(self):
        self.assertEqual(self.options(1), "1 -n 1 --bind-to none -x OMP_NUM_THREADS -x PORESHOCK_TERMINAL program a b")
        self.assertEqual(self.options(2), "1 -n 2 -x OMP_NUM_THREADS -x PORESHOCK_TERMINAL program a b")
        self.assertEqual(self.options(3),
                         "1 -n 3 --oversubscribe --bind-to none -x OMP_NUM_THREADS -x PORESHOCK_TERMINAL program a b")
        self.assertEqual(self.options(64, SLURM_JOB_ID="7"), "1 -n 64 -x OMP_NUM_THREADS -x PORESHOCK_TERMINAL program a b")
        self.assertEqual(self.call(ROOT / "tools/mpirun", "-n", "0", "program").returncode, 2)

    def test_cores_are_physical_and_usable(self):
        self.script(self.bin / "nproc", "echo 8\n")
        self.script(self.bin / "lscpu", "printf '# text\\n0,0\\n0,0\\n1,0\\n1,0\\n'\n")
        self.assertEqual(self.call(ROOT / "tools/cores").stdout, "2\n")
        self.script(self.bin / "lscpu", "exit 1\n")
        self.assertEqual(self.call(ROOT / "tools/cores").stdout, "8\n")

    def prepare_run(self):
        for name in ("run", "stop_with_checkpoint.sh"):
            (self.root / "tools").mkdir(exist_ok=True)
            (self.root / "tools" / name).write_text((ROOT / "tools" / name).read_text())
        (self.root / "tools/run").chmod(0o755)
        (self.root / "input").mkdir()
        (self.root / "input/plate.toml").write_text("")
        self.script(self.root / "tools/cores", "echo 2\n")
        self.script(self.root / "tools/install", "")
        self.script(self.root / "tools/build", "")
        (self.root / "tools/report.py").write_text("import sys; print('report', *sys.argv[1:])")
        # Makes the folder that follows --output and fails as poreshock does on a bad state.
        self.script(self.root / "tools/mpirun",
                    'echo "$*"\nwhile [[ $1 != --output ]]; do shift; done\nmkdir -p "$2"\nexit "${CODE:-0}"\n')

    def test_run_refuses_options_without_a_value(self):
        self.prepare_run()
        for arguments in (["--output", ""], ["--output="], ["--restart", ""], ["-n", ""]):
            done = self.call("tools/run", "input/plate.toml", *arguments)
            self.assertEqual(done.returncode, 2)
            self.assertEqual(done.stderr, f"tools/run: {arguments[0].rstrip('=')}: found an empty text; give a value, or leave the "
                             "option out\n")
        self.assertFalse((self.root / "output").exists())

    def test_run_never_overwrites_and_draws_the_report(self):
        self.prepare_run()
        program = self.root / "build/release/poreshock"
        for number in ("", "-2", "-3"):
            folder = self.root / f"output/plate{number}"
            done = self.call("tools/run", "input/plate.toml", "--set", "time.end=1e-7")
            self.assertEqual(done.stdout.splitlines(), [
                f"-n 2 {program} run input/plate.toml --output {folder} --set time.end=1e-7",
                f"report {folder}"], done.stderr)
            self.assertEqual(done.returncode, 0)

    def test_run_goes_on_in_the_newest_folder_and_keeps_the_exit_code(self):
        self.prepare_run()
        for number in ("", "-2"):
            (self.root / f"output/plate{number}").mkdir(parents=True)
        done = self.call("tools/run", "input/plate.toml", "-n", "4", "--restart", "latest", CODE="3")
        self.assertEqual(done.stdout.splitlines()[0],
                         f"-n 4 {self.root}/build/release/poreshock run input/plate.toml "
                         f"--output {self.root}/output/plate-2 --restart latest")
        self.assertEqual(done.returncode, 3)

    def test_run_explains_a_scene_that_is_not_there(self):
        done = self.call(ROOT / "tools/run", "nothing.toml")
        self.assertEqual(done.returncode, 2)
        self.assertIn("there is no scene file 'nothing.toml'", done.stderr)

    def chain(self, on_signal):
        """Lines and exit code of a chained Slurm job that is told that its time is over."""
        for name in ("tools/stop_with_checkpoint.sh", "jobscripts/resubmit.sh", "jobscripts/slurm_chain.sh"):
            self.script(self.root / name, (ROOT / name).read_text())
        # In the place of a run: `on_signal` is what USR1 makes it do; without it the run ends by itself.
        wait = f"trap '{on_signal}; exit 0' USR1; echo ready; while :; do sleep 0.05; done" if on_signal else ""
        self.script(self.root / "tools/mpirun", f'echo "run $*"\nmkdir -p out\n{wait}\n')
        self.script(self.bin / "sbatch", 'echo "sbatch $*"\n')
        self.script(self.bin / "squeue", "echo 2:00:00\n")
        job = subprocess.Popen(
            ["bash", "jobscripts/slurm_chain.sh", "s.toml", "out"], cwd=self.root, text=True,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            env=os.environ | {"PATH": f"{self.bin}:{os.environ['PATH']}", "SLURM_SUBMIT_DIR": str(self.root),
                              "SLURM_NTASKS": "8", "SLURM_JOB_ID": "1", "SLURM_JOB_PARTITION": "long"})
        lines = [job.stdout.readline().strip()]
        if on_signal:
            self.assertEqual(job.stdout.readline(), "ready\n")
            job.send_signal(signal.SIGUSR1)
        # Not communicate: it would miss what the stream has read ahead.
        return lines + job.stdout.read().splitlines(), job.wait(timeout=30)

    def test_chain_submits_itself_until_the_run_is_done(self):
        start = "run -n 8 build/release/poreshock run s.toml --output out"
        stop = "Stopping: waiting for the checkpoint."
        again = "sbatch --ntasks=8 --time=2:00:00 --partition=long jobscripts/slurm_chain.sh s.toml out"
        self.assertEqual(self.chain("touch out/checkpoint_000010.h5"), ([start, stop, again], 0))
        # The next job goes on; without a newer checkpoint the chain ends instead of running for ever.
        lines, code = self.chain("true")
        self.assertEqual((lines[:2], code), ([start + " --restart latest", stop], 1))
        self.assertIn("wrote no checkpoint", lines[2])
        self.assertEqual(self.chain(""), ([start + " --restart latest", "The run is done."], 0))

    def test_install_names_what_is_missing_and_updates_first(self):
        self.script(self.bin / "dpkg-query", '[[ ${!#} == metis* || ${!#} == libmetis-dev ]] || echo installed\n')
        # What apt-get says of each package is not shown, its errors are.
        self.script(self.bin / "apt-get", 'echo "Unpacking $*"\necho "apt-get $*" >&2\n')
        self.script(self.bin / "id", "echo 0\n")
        done = self.call(ROOT / "tools/install")
        self.assertEqual(done.stdout, "tools/install: installing libmetis-dev\n")
        self.assertEqual(done.stderr.splitlines(), [
            "apt-get update -qq", "apt-get install -y -qq --no-install-recommends libmetis-dev"])
        self.script(self.bin / "id", "echo 1000\n")
        self.script(self.bin / "sudo", 'echo "sudo $1" >&2\n')
        self.assertEqual(self.call(ROOT / "tools/install").stderr.splitlines(), ["sudo apt-get", "sudo env"])
        self.script(self.bin / "dpkg-query", "echo installed\n")
        done = self.call(ROOT / "tools/install")
        self.assertEqual((done.stdout, done.stderr, done.returncode), ("", "", 0))

    def test_lint_tells_what_is_missing_and_what_was_found(self):
        for name in ("bash", "dirname", "git", "grep", "printf"):
            (self.bin / name).symlink_to(shutil.which(name))
        self.script(self.bin / "shellcheck", 'printf "%s\\n" "$@"\n')
        self.script(self.bin / "codespell", '[[ " $* " == *" tools/README.md "* && "$*" != *.png* ]]\n')
        done = self.call(ROOT / "tools/lint", "--quick", PATH=str(self.bin))
        self.assertEqual((done.stderr, done.returncode),
                         ("tools/lint: ruff is not installed, so it was not run: pipx install ruff\n", 0))
        self.assertLessEqual({*SCRIPT_NAMES, "jobscripts/resubmit.sh"}, set(done.stdout.split()))
        self.assertEqual([name for name in done.stdout.split() if name.endswith(".py")], [])
        self.script(self.bin / "ruff", '[[ " $* " != *" tools/report.py "*" tools/sweep "* ]]\n')
        self.script(self.bin / "shellcheck", "exit 0\n")
        self.assertEqual(self.call(ROOT / "tools/lint", "--quick", PATH=str(self.bin)).returncode, 0)
        self.script(self.bin / "codespell", "exit 65\n")
        self.assertEqual(self.call(ROOT / "tools/lint", "--quick", PATH=str(self.bin)).returncode, 1)

    def test_a_reader_that_stops_early_is_no_fault(self):
        (self.root / "scene.toml").write_text("")
        (self.root / "table.toml").write_text('scene = "scene.toml"\n[vary]\n"sample.seed" = [1, 2]\n')
        (self.root / "Makefile").write_text("")  # what check_layers.py tells of
        for command in (["reproduce_paper", "--list"], ["sweep", "table.toml", "--list"], ["plate_exact.py"],
                        ["check_layers.py", self.root]):
            read, write = os.pipe()
            os.close(read)
            done = subprocess.run([ROOT / "tools" / command[0], *command[1:]], cwd=self.root, stdout=write,
                                  stderr=subprocess.PIPE, text=True, check=False)
            os.close(write)
            self.assertEqual((done.stderr, done.returncode), ("", -signal.SIGPIPE), command)


if __name__ == "__main__":
    unittest.main()
