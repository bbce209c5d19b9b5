#!/usr/bin/python3
"""Tests of scripts/run_shards with munged, slurmctld and slurmd as processes of this test, on loopback.

Exit status 77 (SKIPPED) where the programs are not installed.
"""

import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

PACKAGE = pathlib.Path(__file__).resolve().parent.parent.parent
SCRIPTS = PACKAGE / "scripts"
SKIPPED = 77
# A shard: notes that it began, waits for `go` while its own `wait` file is there, fails while its own `fail` file is, and
# writes what it was told.
SHARD = """#!/bin/bash
number=${2%/*}
echo "begins $2"
echo "$number" >>"$1/begun"
while [ -e "$1/wait_$number" ]; do sleep 0.05; done
[ ! -e "$1/fail_$number" ] || { echo "shard $2 fails"; exit 3; }
echo "$2" >"$1/out_$number.new" && mv "$1/out_$number.new" "$1/out_$number"
"""
WAIT = 120  # [s], for an event; never a duration of the test


def until(event, what):
    end = time.monotonic() + WAIT
    while not event():
        if time.monotonic() > end:
            raise AssertionError("waited %d s in vain for %s" % (WAIT, what))
        time.sleep(0.05)


CONFIGURATION = """
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={node}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
CryptoType=crypto/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/builtin
SchedulerParameters=batch_sched_delay=0,sched_interval=1
ReturnToService=2
KillWait=5
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP OverSubscribe=FORCE:4
"""


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Cluster:
    """munged, slurmctld and slurmd as processes of this test, in a temporary folder. stop() ends them by their process ids."""

    def __init__(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="slurm_", dir="/tmp"))
        self.folder.chmod(0o755)  # munged refuses a socket in a folder that others cannot enter
        self.processes = []

    def start(self):
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        host = socket.gethostname().split(".")[0]
        user = subprocess.run(["id", "-un"], capture_output=True, text=True, check=True).stdout.strip()
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(
            host=host, controller=free_port(), node=free_port(), user=user, folder=self.folder, cores=os.cpu_count()))
        (self.folder / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\nIgnoreSystemd=yes\n")
        os.environ["SLURM_CONF"] = str(self.folder / "slurm.conf")
        self.daemon("munged", "--foreground", "--force", "--key-file", str(key), "--socket", str(self.folder / "munge.socket"),
                    "--pid-file", str(self.folder / "munged.pid"), "--log-file", str(self.folder / "munged.log"),
                    "--seed-file", str(self.folder / "munged.seed"))
        until((self.folder / "munge.socket").exists, "munged")
        self.daemon("slurmctld", "-D", "-c", "-f", os.environ["SLURM_CONF"])
        self.daemon("slurmd", "-D", "-c", "-N", host, "-f", os.environ["SLURM_CONF"])
        until(self.ready, "a node that is idle:\n" + self.said())

    def daemon(self, name, *words):
        with open(self.folder / (name + ".out"), "wb") as out:
            self.processes.append(subprocess.Popen([shutil.which(name), *words], stdout=out, stderr=out, cwd=self.folder))

    def ready(self):
        dead = [process.args[0] for process in self.processes if process.poll() is not None]
        if dead:
            raise unittest.SkipTest("%s does not run here: %s" % (dead[0], self.said()))
        done = subprocess.run(["sinfo", "--noheader", "--format=%t"], capture_output=True, text=True, check=False)
        return done.stdout.strip() == "idle"

    def said(self):
        return "\n".join(path.name + ": " + path.read_text(errors="replace").strip()[-600:] for path in self.folder.glob("*.out"))

    def stop(self):
        for process in reversed(self.processes):
            process.terminate()
            try:
                process.wait(timeout=20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


class RunShards(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.cluster = Cluster()
        cls.addClassCleanup(cls.cluster.stop)
        cls.cluster.start()

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="shards ")  # a space, which must not part a word
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.log = self.folder / "log"
        self.shard = self.folder / "shard.sh"
        self.shard.write_text(SHARD)
        self.shard.chmod(0o755)

    def start(self, *more, shards=4, command=None):
        usual = [str(SCRIPTS / "run_shards"), "--shards", str(shards), "--log", str(self.log), "--jobs", "2", *more, "--"]
        return subprocess.Popen([*usual, *(command or [str(self.shard), str(self.folder), "{shard}"])], stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True, cwd=self.folder)

    def run_all(self, *more, **options):
        run = self.start(*more, **options)
        out, err = run.communicate()
        return subprocess.CompletedProcess(run.args, run.returncode, out, err)

    def begun(self):
        path = self.folder / "begun"
        return sorted(path.read_text().split()) if path.exists() else []

    def told(self):
        return sorted(path.read_text().strip() for path in self.folder.glob("out_?"))

    def test_runs_every_shard_once(self):
        done = self.run_all()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((self.told(), self.begun()), (["1/4", "2/4", "3/4", "4/4"], ["1", "2", "3", "4"]))
        self.assertEqual((self.log / "shard_3.log").read_text(), "begins 3/4\n")

    def test_does_nothing_when_all_is_done(self):
        self.run_all()
        done = self.run_all()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.begun(), ["1", "2", "3", "4"])

    def test_runs_only_what_failed_again(self):
        (self.folder / "fail_2").touch()
        done = self.run_all()
        self.assertEqual(done.returncode, 1)
        self.assertIn("shard 2/4 did not end well; see", done.stderr)
        self.assertIn("3 of 4 shards ended well", done.stderr)
        self.assertIn("shard 2/4 fails", (self.log / "shard_2.log").read_text())
        (self.folder / "fail_2").unlink()
        done = self.run_all()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((len(self.told()), self.begun()), (4, ["1", "2", "2", "3", "4"]))

    def test_goes_on_when_it_was_interrupted(self):
        for number in (3, 4):
            (self.folder / ("wait_%d" % number)).touch()
        run = self.start()
        until(lambda: len(self.told()) == 2 and "3" in self.begun(), "two shards that ended and one that runs")
        run.send_signal(signal.SIGTERM)
        run.communicate()
        self.assertNotEqual(run.returncode, 0)
        self.assertEqual(self.told(), ["1/4", "2/4"])
        for number in (3, 4):
            (self.folder / ("wait_%d" % number)).unlink()
        time.sleep(0.5)  # a shard that was not ended would write now
        self.assertEqual(self.told(), ["1/4", "2/4"])
        done = self.run_all()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.told(), ["1/4", "2/4", "3/4", "4/4"])
        self.assertEqual([self.begun().count(number) for number in "12"], [1, 1])

    def test_refuses_what_would_be_wrong(self):
        self.run_all(shards=1)
        for words, options, said in [
                ([], {"shards": 2}, "command.json: shards is 2 here and 1 there; choose another --log"),
                ([], {"shards": 0}, "--shards is 0, but must be 1 or more"),
                ([], {"shards": 1, "command": ["true"]}, "the command has no {shard}"),
                (["--jobs", "0"], {"shards": 1}, "--jobs is 0, but must be 1 or more")]:
            done = self.run_all(*words, **options)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(said, done.stderr)


def main():
    os.environ["PATH"] += ":/usr/sbin:/sbin"
    missing = [program for program in ("munged", "slurmctld", "slurmd", "sbatch", "scancel", "sinfo") if not shutil.which(program)]
    if missing:
        print("SKIPPED: %s is not installed (scripts/install_packages test)" % missing[0])
        return SKIPPED
    done = unittest.main(verbosity=2, exit=False).result
    if done.skipped and done.wasSuccessful():
        print("SKIPPED: %s" % done.skipped[0][1])
        return SKIPPED
    return 0 if done.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
