"""A Slurm of one node for a test: munged, slurmctld and slurmd without systemd and cgroups."""
import os
import re
import secrets
import shutil
import socket
import subprocess
import time

CONFIGURATION = """
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/munge/socket
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/builtin
SlurmdParameters=config_overrides
ReturnToService=2
KillWait=10
MailProg=/bin/true
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=long Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class NoSlurm(Exception):
    """Why there is none."""


class OneNode:
    """Daemons that run until close(); NoSlurm when they cannot."""

    def __init__(self, folder, cpus=2):
        self.folder, self.daemons = folder, []
        missing = [name for name in ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "sinfo") if not shutil.which(
            name, path=os.environ["PATH"] + ":/usr/sbin:/sbin")]
        if missing:
            raise NoSlurm(f"{', '.join(missing)} not found; install slurm-wlm and munge")
        if os.geteuid() != 0:
            raise NoSlurm("slurmd runs jobs of others and so must be started as root")
        host = socket.gethostname().split(".")[0]
        for name in ("munge", "state", "spool"):
            (folder / name).mkdir(mode=0o755)
        (folder / "munge/key").write_bytes(secrets.token_bytes(1024))
        (folder / "munge/key").chmod(0o400)
        (folder / "slurm.conf").write_text(CONFIGURATION.format(host=host, ports=free_ports(2), folder=folder, cpus=cpus))
        self.environment = {name: value for name, value in os.environ.items() if not name.startswith("SLURM")} | {
            "SLURM_CONF": str(folder / "slurm.conf"), "PATH": os.environ["PATH"] + ":/usr/sbin:/sbin"}
        try:
            self.begin(host)
        except Exception:
            self.close()
            raise

    def begin(self, host):
        munge = self.folder / "munge"
        self.start("munged", "--foreground", "--force", f"--key-file={munge}/key", f"--socket={munge}/socket",
                   f"--pid-file={munge}/pid", f"--log-file={munge}/log", f"--seed-file={munge}/seed")
        self.wait(lambda: (munge / "socket").exists(), "munged")
        self.start("slurmctld", "-D", "-c")
        self.start("slurmd", "-D", "-N", host)
        self.wait(lambda: self.call("sinfo", "--noheader", "--format=%T").strip() == "idle", "slurmd")

    def start(self, *command):
        log = open(self.folder / f"{command[0]}.out", "w", encoding="utf-8")
        self.daemons.append(subprocess.Popen(command, env=self.environment, stdout=log, stderr=subprocess.STDOUT,
                                             cwd=self.folder, start_new_session=True))
        log.close()

    def wait(self, ready, who):
        end = time.monotonic() + 60
        while not ready():
            if time.monotonic() > end:
                logs = "\n".join(path.read_text(errors="replace")[-2000:] for path in self.folder.glob("*.log"))
                raise NoSlurm(f"{who} does not come up:\n{logs}")
            time.sleep(0.2)

    def call(self, *command, cwd=None, **environment):
        done = subprocess.run([str(part) for part in command], cwd=cwd, capture_output=True, text=True, check=False,
                              env=self.environment | environment, timeout=60)
        return done.stdout if done.returncode == 0 else done.stderr

    def jobs(self):
        """Numbers and states of the jobs that wait or run."""
        return self.call("squeue", "--noheader", "--format=%i %T").strip()

    def cancel(self):
        """Ends all jobs and what they started, without notice."""
        for job in re.findall(r"^\d+", self.jobs(), re.M):
            self.call("scancel", "--signal=KILL", "--full", job)
            self.call("scancel", job)
        end = time.monotonic() + 20
        while self.jobs() and time.monotonic() < end:
            time.sleep(0.5)

    def close(self):
        if len(self.daemons) == 3:
            self.cancel()
        for daemon in reversed(self.daemons):
            daemon.terminate()
            try:
                daemon.wait(timeout=20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
