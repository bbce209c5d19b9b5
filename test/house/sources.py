#!/usr/bin/python3
"""Rules that the sources keep: which room may use which, one type for each name, and one name for each temporary file of a test."""
import collections
import pathlib
import re
import sys
import unittest

SOURCE = pathlib.Path(__file__).resolve().parent.parent.parent
TOPS = SOURCE / "include/fsr_pressure_map", SOURCE / "src"

# The storeys of docs/how_it_is_built.md: a room may use rooms on lower storeys only.
STOREYS = [["settings"], ["hdf5", "matrix", "statistics", "rheology"], ["regression", "dataset", "map", "protocol", "mesh"],
           ["compensation", "simulation", "health", "view"], ["calibration", "emulator"], ["study", "discrepancy", "check"],
           ["report", "exports"], ["session"], ["ros"], ["nodes", "tools"]]
STOREY = {room: number for number, rooms in enumerate(STOREYS) for room in rooms}
# Folders of a room. Each may use only those before it. Files directly in the room's folder may use all of them.
CORRIDORS = {"ros": ["messages", "bags", "programs", "live", "driver", "recording", "tools"],
             "discrepancy": ["samples", "fit", "decide", "prove"]}
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
ROS_HEADER = re.compile(r"(ros|rosbag|nodelet|pluginlib|std_msgs|std_srvs|sensor_msgs|geometry_msgs|visualization_msgs|diagnostic_msgs|"
                        r"diagnostic_updater|rosgraph_msgs|tf2_ros|topic_tools|rviz)/|fsr_pressure_map/[A-Z][A-Za-z]*\.h$")


def files_in(*folders):
    return sorted(path for folder in folders for path in folder.rglob("*") if path.is_file())


def text_of(path):
    return path.read_text(encoding="utf-8", errors="replace")


def room_of(path):
    return next((path.relative_to(top).parts[0] for top in TOPS if top in path.parents), "")


def includes_of(path):
    return INCLUDE.findall(text_of(path))


def target_room(target):
    """The room that an include points to; "" for a header from outside the package's rooms. Public headers are included as
    "fsr_pressure_map/room/file.h", those beside their sources as "room/file.h"."""
    public, _, rest = target.rpartition("fsr_pressure_map/")
    if "/" not in rest or (not target.startswith("fsr_pressure_map/") and not (SOURCE / "src" / target).exists()):
        return ""
    return rest.split("/")[0]


def all_includes():
    return [(path, room_of(path), target) for path in files_in(*TOPS) for target in includes_of(path)]


class Rooms(unittest.TestCase):
    def assert_none(self, wrong):
        self.assertEqual(wrong, [], "\n".join(map(str, wrong)))

    def test_every_folder_is_a_room_with_a_storey(self):
        self.assert_none([str(path) for path in files_in(*TOPS) if room_of(path) not in STOREY])

    def test_no_room_uses_its_own_storey_or_a_higher_one(self):
        arrows = [(str(path), target, STOREY[room], STOREY[target_room(target)]) for path, room, target in all_includes()
                  if target_room(target) not in ("", room)]
        self.assertGreater(len(arrows), 5)
        self.assert_none([arrow for arrow in arrows if arrow[3] >= arrow[2]])

    def test_tests_of_a_room_use_no_higher_room(self):
        """So that they build without the storeys above."""
        arrows = [(str(path), target, STOREY[folder.name], STOREY[target_room(target)]) for folder in (SOURCE / "test").iterdir()
                  if folder.name in STOREY for path in files_in(folder) for target in includes_of(path) if target_room(target)]
        self.assertGreater(len(arrows), 100)
        self.assert_none([arrow for arrow in arrows if arrow[3] > arrow[2]])

    def test_no_folder_of_a_room_uses_a_later_one(self):
        arrows = []
        for room, corridors in CORRIDORS.items():
            self.assert_none([name for name in corridors if not (SOURCE / "src" / room / name).is_dir()])
            for path in files_in(SOURCE / "src" / room):
                here = path.relative_to(SOURCE / "src" / room).parts[0]
                for target in includes_of(path):
                    there = target.split("/")[1] if target.startswith(room + "/") else ""
                    if here in corridors and there in corridors:
                        arrows.append((str(path), target, corridors.index(here), corridors.index(there)))
        self.assertGreater(len(arrows), 100)
        self.assert_none([arrow for arrow in arrows if arrow[3] > arrow[2]])

    def test_no_room_is_too_large(self):
        files = collections.Counter(path.parent for path in files_in(*TOPS))
        self.assert_none([str(folder) for folder, count in files.items() if count > 44])

    def test_only_the_rooms_of_ros_include_ros(self):
        self.assert_none([(str(path), target) for path, room, target in all_includes()
                          if STOREY[room] < STOREY["ros"] and ROS_HEADER.match(target)])

    def test_calibration_never_uses_the_simulation(self):
        self.assert_none([str(path) for path, room, target in all_includes()
                          if room in ("compensation", "calibration") and target_room(target) == "simulation"])

    def test_blind_data_use_no_formula_of_the_package(self):
        """They would make its search look too good."""
        seen, left = set(), files_in(SOURCE / "test/blind")
        while left:
            path = left.pop()
            if path.is_file() and path not in seen:
                seen.add(path)
                left += [SOURCE / root / target for root in ("include", "src", "test") for target in includes_of(path)]
        self.assertIn(TOPS[0] / "dataset/recording.h", seen, "indirect includes are found")
        self.assert_none([str(path) for path in seen if room_of(path) in ("simulation", "discrepancy", "rheology", "emulator")])


def types_in(text):
    """Types that a formatted text defines at the scope of a namespace with a name: "fsr::map::Region"."""
    scopes, types = [], set()
    for line in re.sub(r"(?m)^namespace [\w:]+ \{\n[^\n]*\n\}$", "", text).splitlines():  # without forward declarations
        opened = re.match(r"(?:inline )?namespace ([\w:]*) ?\{$", line)
        defined = re.match(r"(?:class|struct|union|enum(?: class)?) (?:\[\[.*\]\] |alignas\(.*?\) )?(\w+)(?: final)?(?: :(?!:)| ?\{|$)", line)
        if opened:
            scopes.append(opened[1])
        elif line.startswith("}  // namespace"):
            scopes.pop()
        elif defined and "" not in scopes and ("{" in line or not line.endswith(";")):
            types.add("::".join([*scopes, defined[1]]))
    return types


class TypeNames(unittest.TestCase):
    """Two different types of one name in one program are undefined behaviour: the linker keeps one of their constructors for both. A type
    of the tests may have the name of one in another folder of tests, which is another program, but of none in the library."""

    def test_no_type_name_twice_in_one_namespace(self):
        places = collections.defaultdict(set)
        for path in files_in(SOURCE / "include", SOURCE / "src"):
            for name in types_in(text_of(path)):
                places[name].add(str(path))
        self.assertGreater(len(places), 200)
        for path in files_in(SOURCE / "test"):
            for name in types_in(text_of(path)):
                place = name if name in places else "%s in %s" % (name, path.parts[len(SOURCE.parts) + 1])
                places[place].add(str(path))
        self.assertEqual({name: files for name, files in places.items() if len(files) > 1}, {})


class TemporaryFiles(unittest.TestCase):
    """ctest runs the cases of one suite side by side, each in a process of its own, and two builds may be tested at once: a common name
    lets one case remove what the other reads."""

    def test_carry_their_process_in_their_name(self):
        files = [path for path in files_in(SOURCE / "test") if path.suffix in (".cpp", ".h")]
        self.assertGreater(len(files), 100)
        shared = [(str(path), statement) for path in files for statement in text_of(path).split(";")
                  if re.search(r"(TempDir|temp_directory_path)\(\)", statement) and not re.search(r"getpid\(\)|XXXXXX", statement)]
        self.assertEqual(shared, [])


if __name__ == "__main__":
    sys.exit(unittest.main())
