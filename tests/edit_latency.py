"""Measures how soon the editor shows an edit: a benchmark, not a test.

Usage: edit_latency.py FARFIELD SCENE NODE...

Duplicates each NODE (a name in the tree) in turn and reads the program's own statistics: the time from a change of the
scene, here of its structure, to the first picture of it. Measure with MESA_SHADER_CACHE_DISABLE=true.
"""
import shutil
import statistics
import sys
import tempfile
from pathlib import Path

from editor_window_test import Display, Editor


def main():
    program, bundled, names = sys.argv[1], Path(sys.argv[2]), sys.argv[3:]
    with tempfile.TemporaryDirectory(prefix="farfield-latency-") as folder, Display() as display:
        scene = Path(folder) / "scene.json"
        shutil.copyfile(bundled, scene)
        with Editor(display, program, scene, Path(folder) / "report.json") as editor:
            editor.wait("a first picture", lambda r: r["pictures"] >= 2 and r["specialised"])
            times = []
            for name in names:
                editor.click("tree/" + name)
                editor.wait("the selection", lambda r: r["selection"] == name)
                editor.settled()
                before = editor.report()
                editor.key("ctrl+d")
                after = editor.wait("a picture of the edit", lambda r: r["revision"] != before["revision"]
                                    and r["edit_milliseconds"] != before["edit_milliseconds"])
                times.append(after["edit_milliseconds"])
                editor.settled()
            print(f"{bundled.name}: structural edit to first picture, median {statistics.median(times):.0f} ms of",
                  ", ".join(f"{t:.0f}" for t in times))


if __name__ == "__main__":
    main()
