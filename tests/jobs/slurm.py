#!/usr/bin/env python3
"""limn farm slurm on a real cluster of one machine: python3 tests/jobs/slurm.py LIMN

Starts slurmctld and slurmd, draws 24 frames by 8 tasks of which two are killed or fail once, and compares the set with
a local run. 77 where Slurm is not installed or may not be started.
"""

import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.dont_write_bytecode = True
sys.path.insert(0, HERE)
from safety import Runs, hashes, out, reference  # noqa: E402

CONF = """ClusterName=limn
SlurmctldHost={host}
SlurmctldPort={port}
SlurmdPort={slurmd}
SlurmUser=root
SlurmdUser=root
AuthType=auth/none
AuthInfo=cred_expire=5
CredType=cred/none
ProctrackType=proctrack/pgid
TaskPlugin=task/none
MpiDefault=none
SwitchType=switch/none
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,bf_interval=1
ReturnToService=2
StateSaveLocation={place}/state
SlurmdSpoolDir={place}/spool
SlurmctldPidFile={place}/slurmctld.pid
SlurmdPidFile={place}/slurmd.pid
SlurmctldLogFile={place}/slurmctld.log
SlurmdLogFile={place}/slurmd.log
KillWait=5
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Cluster:
    def __init__(self, place):
        self.place = os.path.join(place, "slurm")
        for folder in ("state", "spool"):
            os.makedirs(os.path.join(self.place, folder))
        self.conf = os.path.join(self.place, "slurm.conf")
        host = socket.gethostname().split(".")[0]
        with open(self.conf, "w") as file:
            file.write(CONF.format(host=host, place=self.place, port=free_port(), slurmd=free_port()))
        self.environment = {**os.environ, "SLURM_CONF": self.conf}
        log = open(os.path.join(self.place, "daemons.log"), "w")
        self.daemons = [
            subprocess.Popen([program, "-D", "-f", self.conf], stdout=log, stderr=log, env=self.environment)
            for program in ("/usr/sbin/slurmctld", "/usr/sbin/slurmd")
        ]

    def ask(self, *command):
        return subprocess.run(command, capture_output=True, text=True, env=self.environment).stdout

    def is_ready(self):
        for _ in range(60):
            if re.search(r"\b(idle|mix|alloc)", self.ask("sinfo", "-h", "-o", "%t")):
                return True
            if any(daemon.poll() is not None for daemon in self.daemons):
                return False
            time.sleep(0.5)
        return False

    def stop(self):
        for daemon in reversed(self.daemons):
            daemon.send_signal(signal.SIGTERM)
        for daemon in self.daemons:
            try:
                daemon.wait(15)
            except subprocess.TimeoutExpired:
                daemon.kill()


def fail_once(script, limn, place):
    """Lets tasks 2 and 5 fail once: one kills limn as the kernel would, the other ends for the moment."""
    wrapper = os.path.join(place, "limn-at-times")
    with open(wrapper, "w") as file:
        file.write(
            """#!/bin/bash
mark={place}/failed-$SLURM_ARRAY_TASK_ID
if [ ! -e $mark ]; then
  [ $SLURM_ARRAY_TASK_ID = 2 ] && {{ touch $mark; {limn} "$@" & sleep 0.3; kill -9 $!; wait $!; exit $?; }}
  [ $SLURM_ARRAY_TASK_ID = 5 ] && {{ touch $mark; exit 75; }}
fi
exec {limn} "$@"
""".format(place=place, limn=limn)
        )
    os.chmod(wrapper, 0o755)
    text = open(script).read()
    assert text.count(limn + " render") == 1, text
    with open(script, "w") as file:
        file.write(text.replace(limn + " render", wrapper + " render"))


def draw(cluster, runs, place):
    config, whole, _ = reference(runs, frames=24)
    shutil.rmtree(out(config))
    folder = os.path.join(place, "farm")
    limn = os.path.realpath(runs.limn)
    film = os.path.join(place, "walk.mp4")
    has_film = shutil.which("ffmpeg") is not None
    command = [limn, "farm", "slurm", config, "--tasks", "8", "--folder", folder]
    if has_film:
        command += ["--set", "output.video='%s'" % film]
    subprocess.run(command, check=True, capture_output=True)
    fail_once(os.path.join(folder, "tasks.sh"), limn, place)
    job = cluster.ask("sbatch", "--parsable", os.path.join(folder, "tasks.sh")).strip()
    assert job.isdigit(), job
    last = cluster.ask("sbatch", "--parsable", "--dependency=afterany:" + job, os.path.join(folder, "last.sh")).strip()
    assert last.isdigit(), last
    ended = time.monotonic() + 300
    while cluster.ask("squeue", "-h", "-j", job + "," + last) and time.monotonic() < ended:
        time.sleep(1)
    said = os.path.join(folder, "logs")
    logs = {name: open(os.path.join(said, name)).read() for name in sorted(os.listdir(said))}
    assert time.monotonic() < ended, cluster.ask("squeue") + str(logs)
    assert hashes(out(config)) == whole, str(logs)
    assert os.path.exists(os.path.join(place, "failed-2")) and os.path.exists(os.path.join(place, "failed-5"))
    # The failed tasks were queued again and did their part: the last job found all frames in place.
    assert logs["last.log"].count("Kept:") == 24, logs["last.log"]
    assert not has_film or os.path.getsize(film) > 1000, logs["last.log"]
    print("24 frames by 8 tasks, two of which failed once: the set is the local run's to the bit")


def main():
    if not (os.path.exists("/usr/sbin/slurmctld") and os.path.exists("/usr/sbin/slurmd") and shutil.which("sbatch")):
        print("Slurm is not installed")
        return 77
    if os.geteuid() != 0:
        print("only root may start slurmd")
        return 77
    with tempfile.TemporaryDirectory() as place:
        runs = Runs(os.path.abspath(sys.argv[1]), place)
        cluster = Cluster(place)
        try:
            assert cluster.is_ready(), open(os.path.join(cluster.place, "daemons.log")).read()[-3000:]
            draw(cluster, runs, place)
        finally:
            cluster.stop()
    return 0


if __name__ == "__main__":
    sys.exit(main())
