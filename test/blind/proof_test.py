#!/usr/bin/python3
"""proof_test.py DISCREPANCY SIMULATE BLIND_CASE: scripts/prove_effects on two effects, one of them random.

The proof of all effects takes minutes: scripts/prove_effects --output DIR.
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest

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

    def test_an_effect_without_a_case_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            done = self.run_proof(folder, "relaxation,gremlins")
            self.assertEqual(done.returncode, 2)
            self.assertIn("--effects names gremlins, but proof_campaign.txt has no such case", done.stderr)


if __name__ == "__main__":
    TOOLS = sys.argv[1:4]
    unittest.main(argv=sys.argv[:1])
