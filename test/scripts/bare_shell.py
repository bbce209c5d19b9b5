"""What the tests of scripts share: the folder of the scripts, and a shell without any environment."""
import pathlib
import subprocess

SCRIPTS = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts"


def run(*words, **more):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True,
                          env={"PATH": "/usr/bin:/bin", "PYTHONDONTWRITEBYTECODE": "1"}, **more)
