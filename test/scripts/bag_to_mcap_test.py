#!/usr/bin/python3
"""scripts/bag_to_mcap: the file has every message of the bag, byte for byte. What the file says is read here by the specification of
MCAP (https://mcap.dev/spec), not by the code that wrote it."""
import pathlib
import struct
import subprocess
import tempfile
import unittest

import rosbag

PACKAGE = pathlib.Path(__file__).resolve().parent.parent.parent
SCRIPT = PACKAGE / "scripts/bag_to_mcap"
BAG = PACKAGE / "test/data/indenter_map.bag"


def string(content, at):
    size, = struct.unpack_from("<I", content, at)
    return content[at + 4:at + 4 + size], at + 4 + size


def records(data):
    """(kind, content) of each record between the two magic words."""
    at = 8
    while at < len(data) - 8:
        kind, size = struct.unpack_from("<BQ", data, at)
        yield kind, data[at + 9:at + 9 + size]
        at += 9 + size


class BagToMcap(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.target = pathlib.Path(folder.name) / "map.mcap"

    def run_script(self, *arguments):
        return subprocess.run([SCRIPT, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)

    def test_keeps_every_message_with_its_type_and_time(self):
        ran = self.run_script(BAG, self.target)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        data = self.target.read_bytes()
        self.assertEqual((data[:8], data[-8:]), (b"\x89MCAP0\r\n",) * 2)
        schemas, channels, found, kinds = {}, {}, [], []
        for kind, content in records(data):
            kinds.append(kind)
            if kind == 3:
                name, at = string(content, 2)
                encoding, at = string(content, at)
                schemas[struct.unpack_from("<H", content)[0]] = name.decode(), encoding, string(content, at)[0].decode()
            elif kind == 4:
                topic, at = string(content, 4)
                self.assertEqual(string(content, at)[0], b"ros1")
                number, schema = struct.unpack_from("<HH", content)
                channels[number] = (topic.decode(), *schemas[schema])
            elif kind == 5:
                number, _, log_time, _ = struct.unpack_from("<HIQQ", content)
                topic, name, encoding, definition = channels[number]
                self.assertEqual(encoding, b"ros1msg")
                found.append((topic, name, definition, log_time, content[22:]))
        with rosbag.Bag(str(BAG)) as bag:
            expected = [(topic, message[0], connection["message_definition"], time.to_nsec(), message[1]) for topic, message, time, connection
                        in bag.read_messages(raw=True, return_connection_header=True)]
        expected = [(topic, name, text.decode() if isinstance(text, bytes) else text, *rest) for topic, name, text, *rest in expected]
        self.assertEqual(found, expected)
        self.assertEqual([kinds[0], *kinds[-3:]], [0x01, 0x0F, 0x0B, 0x02])  # header; end of data, statistics, footer

    def test_never_replaces_a_file(self):
        self.target.write_text("mine")
        ran = self.run_script(BAG, self.target)
        self.assertEqual((ran.returncode, self.target.read_text()), (2, "mine"))
        self.assertEqual(ran.stderr, f"bag_to_mcap: {self.target} exists; name a file that does not\n")

    def test_a_damaged_bag_leaves_no_file(self):
        broken = self.target.with_suffix(".bag")
        broken.write_bytes(BAG.read_bytes()[:100])
        ran = self.run_script(broken, self.target)
        self.assertEqual((ran.returncode, self.target.exists()), (2, False))
        self.assertRegex(ran.stderr, f"^bag_to_mcap: {broken}: .+\n$")


if __name__ == "__main__":
    unittest.main()
