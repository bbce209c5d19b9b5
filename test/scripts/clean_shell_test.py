#!/usr/bin/python3
"""Runs every script of scripts/ and .ci/ in a shell without any environment, as far as it goes without a build.

A script is a file with a #! line. FSR_DEVEL names the devel space of a build; without it the test that needs one is
skipped.
"""
import contextlib
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

PACKAGE = pathlib.Path(__file__).resolve().parent.parent.parent
PASSES_ON = {"test", "open_rviz"}  # hand unknown options to ctest and to rviz
# Scripts that source the build's setup.bash, and the file of python that each of them runs or imports afterwards.
SOURCES_SETUP = {"benchmark": "test/benchmark/peers.py", "demo": "scripts/demo_run.py", "soak": "scripts/rosbag.py"}
SOURCING = re.compile(r"(?:^|[\s'\"])(?:\.|source)\s+\S*/setup\.bash", re.MULTILINE)


def first_line(file):
    with open(file, "rb") as opened:
        return opened.readline().decode(errors="replace")


def scripts():
    places = [*(PACKAGE / "scripts").rglob("*"), *(PACKAGE / ".ci").rglob("*")]
    found = [file for file in places if file.is_file() and "__pycache__" not in file.parts and first_line(file).startswith("#!")]
    return sorted(found)


class CleanShell(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.home = pathlib.Path(folder.name)

    def run_clean(self, *command, **more):
        environment = {"PATH": "/usr/bin:/bin", "HOME": str(self.home), "PYTHONDONTWRITEBYTECODE": "1", **more}
        started = subprocess.Popen([str(word) for word in command], env=environment, cwd=self.home, text=True, start_new_session=True,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        try:
            output, errors = started.communicate(timeout=60)
        finally:  # a script that begins to build is ended with all that it started
            with contextlib.suppress(ProcessLookupError):
                os.killpg(started.pid, signal.SIGKILL)
        return subprocess.CompletedProcess(command, started.returncode, output, errors)

    def test_the_scripts_are_found(self):
        names = {script.name for script in scripts()}
        self.assertLessEqual({"run", "build", "benchmark", "soak", "study.py", *PASSES_ON, *SOURCES_SETUP}, names)

    def test_bash_can_read_them(self):
        for script in scripts():
            with self.subTest(script=script.name):
                if "bash" in first_line(script):
                    done = self.run_clean("bash", "-n", script)
                    self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_they_can_be_started(self):
        for script in scripts():
            with self.subTest(script=script.name):
                self.assertTrue(os.access(script, os.X_OK), "is not executable")

    def test_help_prints_the_usage(self):
        for script in scripts():
            with self.subTest(script=script.name):
                done = self.run_clean(script, "--help")
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.assertIn(script.name.split("_")[0], done.stdout.splitlines()[0])  # demo_options.py says "demo"
                self.assertGreater(len(done.stdout.splitlines()), 2)

    def test_an_unknown_option_is_refused(self):
        for script in (script for script in scripts() if script.name not in PASSES_ON):
            with self.subTest(script=script.name):
                done = self.run_clean(script, "--no-such-option")
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertEqual(done.stdout, "")
                self.assertNotIn("Traceback", done.stderr)
                self.assertIn(script.name.split("_")[0], done.stderr)

    def package_without_work(self):
        """A copy of the scripts that installs and builds nothing; what they start prints its environment."""
        package = self.home / "package"
        shutil.copytree(PACKAGE / "scripts", package / "scripts")
        for name in ("install_packages", "build"):
            (package / "scripts" / name).write_text("#!/bin/bash\nexit 0\n")
        for started in SOURCES_SETUP.values():
            file = package / started
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text("#!/usr/bin/python3\nimport os, sys\nsys.exit(print(os.environ['CMAKE_PREFIX_PATH']))\n")
            file.chmod(0o755)
        return package

    def test_the_environment_of_the_build_is_sourced(self):
        sourcing = {script.name for script in scripts() if SOURCING.search(script.read_text())}
        self.assertEqual(sourcing, set(SOURCES_SETUP), "SOURCES_SETUP must name the scripts that source setup.bash")
        if "FSR_DEVEL" not in os.environ:
            self.skipTest("FSR_DEVEL is not set: there is no build with ROS")
        devel = os.environ["FSR_DEVEL"]
        package = self.package_without_work()
        for name in SOURCES_SETUP:
            with self.subTest(script=name):
                done = self.run_clean(package / "scripts" / name, FSR_BUILD_DIR=os.path.dirname(devel))
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.assertIn(devel, done.stdout.splitlines()[-1].split(":"))


if __name__ == "__main__":
    sys.exit(unittest.main())
