"""Last step of the demo: an effect is hidden in bags, and the tool `discrepancy` looks for it."""
import pathlib
import shutil
import subprocess

import yaml

HIDDEN = ["--effect", "hysteresis:duhem", "--snr", "2", "--protocol", "two_speeds", "--seed", "2024"]


def run(tool, *words, result):
    """Output of the tool. Exit status 3 means that only its figures are missing; rosrun also uses it if there is no such tool."""
    done = subprocess.run(["rosrun", "fsr_pressure_map", tool, *map(str, words)], stdout=subprocess.PIPE, text=True)
    if done.returncode not in (0, 3) or not result.exists():
        raise subprocess.CalledProcessError(done.returncode, tool)
    return done.stdout


def percent(value):
    return "-" if value is None else f"{100 * value:.2f} %"


def find_hidden(folder, say):
    """Makes the bags and the key, runs `discrepancy`, and returns verdict and key side by side."""
    folder = pathlib.Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    run("blind_case", *HIDDEN, "--output", folder / "bags", "--key", folder / "key.yaml",
        result=folder / "key.yaml")
    say("an effect is hidden in six bags; `discrepancy` looks for it, without the key")
    words = run("discrepancy", folder / "bags", "--output", folder / "found",
                result=folder / "found" / "verdict.yaml")
    key = yaml.safe_load((folder / "key.yaml").read_text())
    verdict = yaml.safe_load((folder / "found" / "verdict.yaml").read_text())
    gap = verdict["gap"]
    found = " + ".join(effect["id"] for effect in verdict["effects"]) or "-"
    hidden = " + ".join(f"{effect['id']} ({effect['form']})" for effect in key["effects"])
    return "\n".join([
        words.strip(),
        f"hidden       {hidden}",
        f"found        {found}, verdict {verdict['verdict']}",
        f"gap          {percent(gap['before'])} of full scale before, {percent(gap['after'])} after, "
        f"floor {percent(gap['floor'])}; closed {percent(gap['closed'])}",
        f"report       {folder / 'found' / 'report.html'}"])
