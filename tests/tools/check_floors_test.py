#!/usr/bin/env python3
"""tools/check_floors against small houses, good and bad."""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

ROOMS = {
    "base": {"floor": 0},
    "mesh": {"floor": 1},
    "mesh/io": {"floor": 1, "may_include": ["mesh"]},
    "linalg": {"floor": 1},
    "response": {"floor": 7, "planned": True},
    "haptics": {"floor": 8, "only": ["base", "response/snapshot.h"]},
    "tests/support": {"floor": 11},
    "tests": {"floor": 11, "may_include": ["tests/support"]},
}

FILES = {
    "src/base/vec.h": "#include <vector>\n",
    "src/mesh/tet_mesh.h": '#include "base/vec.h"\n',
    "src/mesh/tet_mesh.cpp": '#include "mesh/tet_mesh.h"\n',
    "src/mesh/io/vtu.cpp": '#include "base/vec.h"\n#include "mesh/tet_mesh.h"\n',
    "src/linalg/solver.h": '#include "base/vec.h"\n',
    "src/haptics/loop.cpp": '#include "base/vec.h"\n',
    "tests/mesh/tet_mesh_test.cpp": '#include "mesh/tet_mesh.h"\n#include "tests/support/near.h"\n',
    "tests/support/near.h": '#include "base/vec.h"\n',
}


def table(rooms):
    state = {True: "planned", False: "here"}
    return "".join(f"| {e['floor']} | `{r}` | {state[e.get('planned', False)]} | ... |\n" for r, e in rooms.items())


class CheckFloors(unittest.TestCase):
    def problems(self, files=None, rooms=None, architecture=None):
        """What check_floors says of the good house with these files and rooms laid over it; one string a problem."""
        rooms = {**ROOMS, **(rooms or {})}
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            house = {
                **FILES,
                "tools/floors.json": json.dumps({"rooms": rooms}),
                "ARCHITECTURE.md": architecture if architecture is not None else table(rooms),
                **(files or {}),
            }
            for name, text in house.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            run = subprocess.run([ROOT / "tools/check_floors", root], capture_output=True, text=True, check=False)
        found = run.stderr.splitlines()
        self.assertEqual(run.returncode, 1 if found else 0, run.stderr)
        return found

    def assert_one(self, problems, *parts):
        self.assertEqual(len(problems), 1, problems)
        for part in parts:
            self.assertIn(part, problems[0])

    def test_good_house(self):
        self.assertEqual(self.problems(), [])

    def test_climbing_include_is_named_by_file_and_line(self):
        found = self.problems({"src/base/vec.h": '#include <vector>\n#include "mesh/tet_mesh.h"\n'})
        self.assert_one(found, "src/base/vec.h:2:", "climbs", "base (floor 0)", "mesh (floor 1)")

    def test_angle_brackets_do_not_hide_a_climb(self):
        self.assert_one(self.problems({"src/base/vec.h": "#  include <mesh/tet_mesh.h>\n"}), "climbs")

    def test_crossing_include(self):
        self.assert_one(self.problems({"src/linalg/solver.h": '#include "mesh/tet_mesh.h"\n'}), "crosses")

    def test_exception_holds_in_one_direction_only(self):
        files = {"src/mesh/io/vtu.h": "", "src/mesh/tet_mesh.h": '#include "mesh/io/vtu.h"\n'}
        self.assert_one(self.problems(files), "src/mesh/tet_mesh.h:1:", "crosses", "mesh/io")

    def test_room_beside_src_opens_to_whom_it_says(self):
        self.assert_one(self.problems({"tests/support/near.h": '#include "tests/mesh/a.h"\n', "tests/mesh/a.h": ""}), "crosses")

    def test_nothing_includes_the_tests(self):
        self.assert_one(self.problems({"src/mesh/a.cpp": '#include "tests/support/near.h"\n'}), "climbs")

    def test_a_room_with_only_reaches_no_other_lower_room(self):
        self.assert_one(self.problems({"src/haptics/loop.cpp": '#include "mesh/tet_mesh.h"\n'}), "strays")

    def test_only_may_name_a_single_header(self):
        files = {
            "src/response/snapshot.h": "",
            "src/response/exact.h": "",
            "src/haptics/loop.cpp": '#include "response/snapshot.h"\n',
        }
        built = {"response": {"floor": 7}}
        self.assertEqual(self.problems(files, built), [])
        files["src/haptics/loop.cpp"] = '#include "response/exact.h"\n'
        self.assert_one(self.problems(files, built), "strays", "response")

    def test_header_that_is_not_named_from_src(self):
        self.assert_one(self.problems({"src/mesh/tet_mesh.cpp": '#include "tet_mesh.h"\n'}), "name headers from src/")

    def test_generated_header_counts_for_its_room(self):
        generated = '#include "mesh/wire_generated.h"\n'
        self.assertEqual(self.problems({"src/mesh/tet_mesh.cpp": generated}), [])
        self.assert_one(self.problems({"src/base/vec.h": generated}), "climbs", "mesh")

    def test_file_outside_every_room(self):
        self.assert_one(self.problems({"src/utils/all.h": ""}), "src/utils/all.h", "in no room")

    def test_planned_room_that_has_sources(self):
        self.assert_one(self.problems({"src/response/a.h": ""}), "response", "planned")

    def test_room_without_sources(self):
        self.assert_one(self.problems(rooms={"element": {"floor": 3}}), "element", "no sources")

    def test_table_and_json_disagree(self):
        moved = {**ROOMS, "linalg": {"floor": 2}}
        self.assert_one(self.problems(architecture=table(moved)), "linalg", "floor 2", "floor 1")
        missing = {room: entry for room, entry in ROOMS.items() if room != "linalg"}
        self.assert_one(self.problems(architecture=table(missing)), "linalg", "says nothing")
        state = {**ROOMS, "response": {"floor": 7}}
        self.assert_one(self.problems(architecture=table(state)), "response", "floor 7, planned")


if __name__ == "__main__":
    sys.exit(unittest.main())
