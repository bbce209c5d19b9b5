"""The demo's last step: something is hidden in bags, and `discrepancy` is asked what."""
import pathlib
import shutil
import subprocess

import yaml

HIDDEN = ["--effect", "hysteresis:duhem", "--snr", "2", "--protocol", "two_speeds", "--seed", "2024"]


def run(tool, *words, result):
    """What the tool prints. 3 = only its figures are missing, but also rosrun's word for no such tool."""
    done = subprocess.run(["rosrun", "fsr_pressure_map", tool, *map(str, words)], stdout=subprocess.PIPE, text=True)
    if done.returncode not in (0, 3) or not result.exists():
        raise subprocess.CalledProcessError(done.returncode, tool)
    return done.stdout


def percent(value):
    return "-" if value is None else f"{100 * value:.2f} %"


def find_hidden(folder, say):
    """Makes bags and sealed key, asks, and returns verdict and key side by side."""
    folder = pathlib.Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    run("blind_case", *HIDDEN, "--output", folder / "bags", "--key", folder / "key.yaml",
        result=folder / "key.yaml")
    say("something is hidden in six bags; `discrepancy` is asked what, without the key")
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
