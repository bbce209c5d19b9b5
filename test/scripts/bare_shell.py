"""What the tests of scripts share: the folder of the scripts, one of them as a module, and a shell without any environment."""
import importlib.machinery
import importlib.util
import pathlib
import subprocess

SCRIPTS = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts"


def module(name):
    loader = importlib.machinery.SourceFileLoader(name, str(SCRIPTS / name))
    script = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(script)
    return script


def run(*words, **more):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True,
                          env={"PATH": "/usr/bin:/bin", "PYTHONDONTWRITEBYTECODE": "1"}, **more)
