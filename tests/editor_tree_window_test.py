"""Drives the editor's tree by mouse and keyboard on a virtual display: several selected nodes, groups, hidden and locked
ones, copy and paste, search, and the list of steps.

Usage: editor_tree_window_test.py FARFIELD SCENE
"""
import json
import sys
import tempfile
import time
from pathlib import Path

from editor_driver import Display, Editor, PATIENCE, check, check_seen, run_steps, run_test

BLOCKS = ["short block", "tall block"]


def click_with(editor, control, key):
    editor.point_at(control)
    editor.display.xdotool("keydown", key, "sleep", 0.1, "click", 1, "sleep", 0.1, "keyup", key)


def select(editor, first, *others):
    """Selects by a click and further ones with Ctrl."""
    editor.click(f"tree/{first}")
    editor.wait(first, lambda r: r["selected"] == [first])
    for i, name in enumerate(others, 1):
        click_with(editor, f"tree/{name}", "ctrl")
        editor.wait(f"{name} too", lambda r: r["selected"] == [first, *others[:i]])


def undo_all(editor):
    while editor.report()["step"] > 0:
        step = editor.report()["step"]
        editor.key("ctrl+z")
        editor.wait("a step back", lambda r: r["step"] < step)
    check(editor.wait("the start", lambda r: r["saved"])["saved"], "undo all brings back the file")


def select_several(editor):
    """Ctrl toggles, Shift takes the range, Ctrl+A all siblings, a click one alone."""
    select(editor, *BLOCKS)
    click_with(editor, "tree/short block", "ctrl")
    editor.wait("one of them", lambda r: r["selected"] == ["tall block"])
    click_with(editor, "tree/short block", "shift")
    editor.wait("the range", lambda r: sorted(r["selected"]) == BLOCKS)
    editor.click("tree/tall block")
    editor.wait("one alone", lambda r: r["selected"] == ["tall block"])
    editor.key("ctrl+a")
    editor.wait("all", lambda r: len(r["selected"]) > 4)
    editor.click("tree/scene")
    editor.wait("the scene", lambda r: r["selected"] == ["scene"])
    # In the picture Ctrl adds what is there.
    editor.click("tree/short block")
    editor.wait("the block", lambda r: r["selected"] == ["short block"])
    click_with(editor, "viewport", "ctrl")
    editor.wait("what is in the middle too", lambda r: len(r["selected"]) == 2)


def edit_several(editor):
    """A value that is dragged changes in all of the kind; one step of undo brings back all, and what was selected."""
    select(editor, *BLOCKS)
    editor.place("inspector/several")
    editor.drag("inspector/half_size/x", by=60)
    editor.wait("a change", lambda r: not r["saved"] and r["step"] == 1)
    editor.click("tree/scene")
    editor.wait("the scene", lambda r: r["selected"] == ["scene"])
    editor.key("ctrl+z")
    editor.wait("all back, and selected", lambda r: r["saved"] and r["selected"] == BLOCKS)


def escape_a_drag(editor):
    """Escape while a value is dragged leaves neither a change nor a step."""
    select(editor, "short block")
    revision = editor.report()["revision"]
    x, y = editor.point_at("inspector/scale")
    editor.display.xdotool("mousedown", 1)
    for i in range(1, 10):
        editor.display.xdotool("mousemove", x + 6 * i, y)
        time.sleep(0.03)
    editor.wait("a change", lambda r: r["revision"] != revision)
    editor.key("Escape")
    editor.wait("no change", lambda r: r["revision"] == revision and r["step"] == 0)
    editor.display.xdotool("mousemove", x + 90, y, "sleep", 0.3, "mouseup", 1)
    editor.settled()
    check(editor.report()["revision"] == revision, "what goes on moving changes nothing")


def group_and_dissolve(editor):
    select(editor, *BLOCKS)
    editor.key("ctrl+g")
    editor.wait("a group", lambda r: r["selected"] == ["group"] and r["step"] == 1)
    editor.key("ctrl+shift+g")
    editor.wait("what was in it", lambda r: sorted(r["selected"]) == BLOCKS and "tree/group" not in r["controls"])
    # By the menu into an operation.
    editor.point_at("tree/tall block")
    editor.display.xdotool("click", 3)
    editor.click("context/Wrap in")
    editor.click("wrap/twist")
    editor.wait("a twist", lambda r: r["selection"] == "Twist" and r["step"] == 3)
    undo_all(editor)


def drag_several(editor):
    """Several dragged nodes land together, in their order."""
    select(editor, *BLOCKS)
    _, y, _, height = editor.place("tree/scene")
    x, from_y = editor.point_at("tree/short block")
    editor.display.xdotool("mousedown", 1)
    for step in range(1, 13):
        editor.display.xdotool("mousemove", x, from_y + (y + height // 2 - from_y) * step // 12)
        time.sleep(0.04)
    editor.display.xdotool("sleep", 0.2, "mouseup", 1)
    report = editor.wait("a move", lambda r: r["step"] == 1)
    check(report["selected"] == BLOCKS, "what was dragged stays selected")
    undo_all(editor)


def hide_and_lock(editor):
    """What is hidden is not seen, what is locked is not deleted."""
    select(editor, "tall block")

    def hide():
        editor.key("h")
        editor.wait("hidden", lambda r: r["step"] == 1)
        editor.settled()

    check_seen(editor, hide, "a hidden block")
    editor.click("tree_eye/tall block")
    editor.wait("shown", lambda r: r["step"] == 2)
    editor.key("shift+h")
    editor.wait("it alone", lambda r: r["step"] == 3)
    editor.key("alt+h")
    editor.wait("everything", lambda r: r["step"] == 4)
    editor.click("tree_lock/tall block")
    editor.wait("locked", lambda r: r["step"] == 5)
    editor.key("Delete")
    report = editor.wait("a message", lambda r: r["error"])
    check(report["error"] == "tall block is locked" and report["step"] == 5, f"refused, not: {report['error']}")
    editor.place("inspector/unlock")
    editor.key("ctrl+a")
    editor.wait("all", lambda r: len(r["selected"]) > 4)
    editor.key("l")
    editor.wait("all locked", lambda r: r["step"] == 6)
    editor.click("viewport")
    editor.wait("nothing but the scene", lambda r: r["selected"] == ["scene"])
    undo_all(editor)


def copy_and_paste(editor):
    """The clipboard holds a scene file; it can be pasted here and into another Farfield."""
    select(editor, *BLOCKS)
    editor.key("ctrl+c", "ctrl+v")
    report = editor.wait("copies", lambda r: r["step"] == 1)
    check(len(report["selected"]) == 2 and not set(report["selected"]) & set(BLOCKS), "the copies are selected")
    copies = report["selected"]
    editor.key("ctrl+x")
    editor.wait("cut", lambda r: r["step"] == 2 and f"tree/{copies[0]}" not in r["controls"])
    editor.key("ctrl+v")
    editor.wait("pasted again", lambda r: r["step"] == 3 and sorted(r["selected"]) == sorted(copies))
    [window] = editor.display.xdotool("search", "--onlyvisible", "--name", "Farfield").split()
    with tempfile.TemporaryDirectory() as folder:
        empty = Path(folder) / "empty.json"
        empty.write_text(json.dumps({"farfield": 1, "root": {"kind": "union"}}))
        with Editor(editor.display, sys.argv[1], empty, Path(folder) / "report.json") as other:
            other.wait("a first picture", lambda r: r["pictures"] >= 2)
            windows = editor.display.xdotool("search", "--onlyvisible", "--name", "Farfield").split()
            editor.display.xdotool("windowfocus", next(w for w in windows if w != window))
            other.key("ctrl+v")
            other.wait("nodes of the other program", lambda r: sorted(r["selected"]) == sorted(copies))
            other.key("ctrl+s")
            other.wait("saved", lambda r: r["saved"])
            saved = json.loads(empty.read_text())
            check([n["name"] for n in saved["root"]["children"]] == sorted(copies), "what was pasted is saved")
            other.key("ctrl+q")
            other.process.wait(PATIENCE)
    editor.display.xdotool("windowfocus", window)
    undo_all(editor)


def search(editor):
    editor.key("ctrl+f")
    editor.type("TALL")
    editor.wait("what is found", lambda r: "tree/tall block" in r["controls"] and "tree/short block" not in r["controls"])
    editor.key("Return")
    editor.wait("the first is selected", lambda r: r["selected"] == ["tall block"])
    editor.key("ctrl+f")
    editor.wait("the field", lambda r: r["typing"])
    editor.key("Escape")
    editor.wait("all nodes", lambda r: "tree/short block" in r["controls"] and not r["typing"])


def go_through_history(editor):
    """A click on a step goes there, with what was selected then."""
    select(editor, "short block")
    editor.key("h")
    editor.wait("one step", lambda r: r["step"] == 1)
    select(editor, "tall block")
    editor.key("h", "h")
    editor.wait("three steps", lambda r: r["step"] == 3)
    editor.key("ctrl+h")
    editor.click("history/1")
    editor.wait("the first step", lambda r: r["step"] == 1 and r["selected"] == ["tall block"])
    editor.click("history/3")
    editor.wait("the last step", lambda r: r["step"] == 3)
    editor.click("history/0")
    editor.wait("the start", lambda r: r["step"] == 0 and r["saved"] and r["selected"] == ["short block"])
    editor.key("ctrl+h")
    editor.wait("no list", lambda r: "history/0" not in r["controls"])


def main():
    run_steps(sys.argv[1], sys.argv[2],
              [select_several, edit_several, escape_a_drag, group_and_dissolve, drag_several, hide_and_lock,
               copy_and_paste, search, go_through_history], "editor_tree_window_failure.png")


if __name__ == "__main__":
    run_test(main)
