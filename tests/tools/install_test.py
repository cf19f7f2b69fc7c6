#!/usr/bin/env python3
"""tools/install with stand-ins for dpkg and apt: what it asks for, and what it says when that cannot be had."""

import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

INSTALL = Path(__file__).resolve().parents[2] / "tools/install"

# $LOG collects the calls of apt; $MISSING, $UNKNOWN and $FAIL say how the machine is.
STAND_INS = {
    "dpkg-query": """
        package=${@: -1}
        case " $MISSING " in *" $package "*) echo not-installed; exit 1 ;; esac
        echo installed""",
    "apt-get": """
        echo "apt-get $*" >>"$LOG"
        [[ " $* " != *" $FAIL "* ]] || { echo "E: what apt says"; exit 100; }""",
    "apt-cache": """
        case " $UNKNOWN " in *" ${@: -1} "*) ;; *) echo "${@: -1} | 1.0 | somewhere" ;; esac""",
    "sudo": """
        exec "$@" """,
}


class Install(unittest.TestCase):
    def run_install(self, *levels, missing="", unknown="", fail="", debian=True, node=""):
        """(exit code, stdout, stderr, calls of apt-get)"""
        with tempfile.TemporaryDirectory() as folder:
            stand_ins = STAND_INS | ({"node": f"echo {node}", "npm": ""} if node else {})
            for name, body in stand_ins.items():
                if debian or name != "dpkg-query":
                    path = Path(folder) / name
                    path.write_text(f"#!/bin/bash\n{body}\n")
                    path.chmod(0o755)
            # Only what the script itself needs of the real machine.
            for name in ("bash", "env", "grep", "sed", "tail", "mktemp", "rm"):
                (Path(folder) / name).symlink_to(shutil.which(name))
            log = Path(folder) / "log"
            log.touch()
            environment = {"PATH": folder, "LOG": str(log), "MISSING": missing, "UNKNOWN": unknown, "FAIL": fail}
            run = subprocess.run(
                ["bash", INSTALL, *levels], env=environment, capture_output=True, text=True, check=False
            )
            return run.returncode, run.stdout, run.stderr, log.read_text().splitlines()

    def test_asks_for_nothing_when_all_is_there(self):
        code, out, _, calls = self.run_install("test")
        self.assertEqual((code, calls), (0, []))
        self.assertIn("are here", out)

    def test_installs_what_is_missing_and_removes_nothing(self):
        code, out, _, calls = self.run_install("build", missing="libhdf5-dev cmake")
        self.assertEqual(code, 0)
        self.assertEqual(out.splitlines()[-1], "install: installed cmake libhdf5-dev")
        self.assertEqual(len(calls), 2)
        self.assertIn("update", calls[0].split())
        words = calls[1].split()
        self.assertEqual(words[-2:], ["cmake", "libhdf5-dev"])
        self.assertIn("--no-remove", words)
        self.assertIn("--no-install-recommends", words)

    def test_building_needs_no_test_tools(self):
        self.assertEqual(self.run_install("build", missing="clang-16")[3], [])
        self.assertEqual(len(self.run_install("test", missing="clang-16")[3]), 2)
        self.assertEqual(len(self.run_install(missing="clang-16")[3]), 2)

    def test_leaves_a_node_alone_that_is_new_enough(self):
        for level in ("viewer", "test"):
            self.assertEqual(self.run_install(level, missing="nodejs npm", node="v20.1.0")[3], [])
            for node in ("v12.22.12", ""):
                calls = self.run_install(level, missing="nodejs npm", node=node)[3]
                self.assertEqual(calls[1].split()[-2:], ["nodejs", "npm"])

    def test_testing_needs_a_browser(self):
        self.assertEqual(self.run_install("test", missing="chromium")[3][1].split()[-1], "chromium")

    def test_only_the_comparison_needs_the_rivals(self):
        missing = "libbullet-dev calculix-ccx"
        self.assertEqual(self.run_install("test", missing=missing)[3], [])
        self.assertEqual(self.run_install("rivals", missing=missing)[3][1].split()[-2:], missing.split())

    def test_names_a_package_that_apt_does_not_know(self):
        code, _, err, calls = self.run_install("build", missing="cmake libtbb-dev", unknown="libtbb-dev")
        self.assertEqual(code, 1)
        self.assertIn("apt knows no package libtbb-dev", err)
        self.assertEqual(len(calls), 1, "nothing is installed by halves")

    def test_says_what_apt_said_when_it_refuses(self):
        code, _, err, _ = self.run_install("build", missing="cmake", fail="install")
        self.assertEqual(code, 1)
        self.assertIn("E: what apt says", err)
        self.assertIn("still missing: cmake", err)

    def test_says_that_the_update_failed(self):
        code, _, err, calls = self.run_install("build", missing="cmake", fail="update")
        self.assertEqual((code, len(calls)), (1, 1))
        self.assertIn("apt-get update failed", err)

    def test_leaves_other_systems_to_cmake(self):
        code, _, err, calls = self.run_install("build", debian=False)
        self.assertEqual((code, calls), (0, []))
        self.assertIn("not a Debian system", err)
        self.assertIn("libeigen3-dev", err)

    def test_unknown_level(self):
        self.assertEqual(self.run_install("everything")[0], 2)


if __name__ == "__main__":
    sys.exit(unittest.main())
