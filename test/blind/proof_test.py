#!/usr/bin/python3
"""proof_test.py DISCREPANCY SIMULATE BLIND_CASE: scripts/prove_effects on two effects, one of them random.

The proof of all effects takes minutes: scripts/prove_effects --output DIR.
"""

import pathlib
import subprocess
import sys
import tempfile
import types
import unittest

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import random_effects  # noqa: E402

PROVE = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts" / "prove_effects"
TOOLS = []


class Proof(unittest.TestCase):
    def run_proof(self, folder, effects):
        discrepancy, simulate, generator = TOOLS
        command = discrepancy + " {bags} --output {output} --no-report --threads 1"
        return subprocess.run([str(PROVE), "--output", folder, "--effects", effects, "--command", command, "--simulate", simulate,
                               "--generator", generator], capture_output=True, text=True)

    def test_named_in_a_foreign_form_and_the_stated_gap_is_the_recomputed_one(self):
        with tempfile.TemporaryDirectory() as folder:
            done = self.run_proof(folder, "relaxation,row_fault")
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            rows = [line for line in pathlib.Path(folder, "proof.md").read_text().split("\n") if line.endswith("| yes |")]
            self.assertEqual(len(rows), 2, done.stdout)

    def test_the_step_of_a_walk_is_measured_between_loaded_cycles(self):
        draw = numpy.random.RandomState(1)
        stamps = numpy.arange(40000) * 10**9  # one scan a second
        pressure = numpy.maximum(0, numpy.sin(stamps * numpy.pi / 30e9))  # a cycle a minute, half of it at rest
        walk = numpy.cumsum(draw.normal(size=(stamps.size, 1)), axis=0)  # 1 count in a root second
        base = types.SimpleNamespace(stamps=stamps, counts=2000 * pressure[:, None] * numpy.ones((1, 3)))
        at_rest = 1e6 * (pressure == 0)[:, None]  # counts for nothing
        step = random_effects.rms_step([walk + at_rest + numpy.zeros((1, 3))], [base], [0, 2])
        self.assertAlmostEqual(step, 60**0.5, delta=0.12 * 60**0.5)  # means over part of a minute lose some of it

    def test_an_effect_without_a_case_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            done = self.run_proof(folder, "relaxation,gremlins")
            self.assertEqual(done.returncode, 2)
            self.assertIn("--effects names gremlins, but proof_campaign.txt has no such case", done.stderr)


if __name__ == "__main__":
    TOOLS = sys.argv[1:4]
    unittest.main(argv=sys.argv[:1])
