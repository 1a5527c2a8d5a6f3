"""A Slurm of one node, in a folder of its own and without systemd: for tests."""

import os
import shutil
import socket
import subprocess
import time
from pathlib import Path

from support import free_port

PLACES = os.environ.get("PATH", "") + ":/usr/sbin"
PROGRAMS = {name: shutil.which(name, path=PLACES)
            for name in ("munged", "slurmctld", "slurmd", "sbatch", "sinfo", "srun", "scontrol")}

SETTINGS = """ClusterName=abut
SlurmctldHost=localhost
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
SlurmctldPort={port}
SlurmdPort={other}
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
MpiDefault=none
SwitchType=switch/none
SlurmdParameters=config_overrides
SchedulerParameters=sched_interval=1
ReturnToService=2
KillWait=5
NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 CPUs=8 RealMemory=1000 State=UNKNOWN
PartitionName=main Nodes=n1 Default=YES MaxTime=INFINITE State=UP
"""


class SlurmNode:
    """Throws OSError or CalledProcessError where it cannot be had."""

    def __init__(self, folder: Path):
        missing = [name for name, program in PROGRAMS.items() if program is None]
        if missing:
            raise OSError(f"there is no {missing[0]} (Debian: slurm-wlm, munge)")
        self.folder = folder
        folder.chmod(0o755)
        for name in ("state", "spool"):
            (folder / name).mkdir()
        key = folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o600)
        settings = folder / "slurm.conf"
        user = subprocess.run(["id", "-un"], capture_output=True, text=True, check=True)
        settings.write_text(SETTINGS.format(
            user=user.stdout.strip(), folder=folder, port=free_port(), other=free_port(),
            host=socket.gethostname()), encoding="utf-8")
        self.environment = {**os.environ, "SLURM_CONF": str(settings)}
        self.daemons = []
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        try:
            for command in (
                    [PROGRAMS["munged"], "--foreground", "--force", f"--key-file={key}",
                     f"--socket={folder}/munge.socket", f"--pid-file={folder}/munged.pid",
                     f"--seed-file={folder}/munge.seed", f"--log-file={folder}/munged.log"],
                    [PROGRAMS["slurmctld"], "-D", "-f", settings],
                    [PROGRAMS["slurmd"], "-D", "-f", settings, "-N", "n1"]):
                self.daemons.append(subprocess.Popen([*map(str, command)], env=self.environment,
                                                     **quiet))
                time.sleep(0.3)
            self.wait_until_idle()
        except Exception:
            self.close()
            raise

    def wait_until_idle(self):
        until = time.monotonic() + 20.0
        while time.monotonic() < until:
            if any(daemon.poll() is not None for daemon in self.daemons):
                break
            said = self.run("sinfo", "--noheader", "--format=%t", check=False)
            if said.stdout.strip() == "idle":
                return
            time.sleep(0.2)
        raise OSError("Slurm does not come up here")

    def run(self, name: str, *arguments: object, check: bool = True, **options):
        return subprocess.run([PROGRAMS.get(name) or name, *map(str, arguments)],
                              env={**self.environment, **options.pop("env", {})}, text=True,
                              capture_output=True, check=check, timeout=120, **options)

    def close(self):
        for daemon in reversed(self.daemons):
            daemon.terminate()
            try:
                daemon.wait(10.0)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
