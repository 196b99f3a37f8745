"""Bookmarks of the camera, the split view and materials, by mouse and keyboard in the editor's real window.

Usage: view_window_test.py FARFIELD SCENE
"""
import json
import sys
import time

from editor_driver import changed_fraction, check, run_steps, run_test

FIRST = {}  # the scene's file as it was


def saved_scene(editor):
    editor.key("ctrl+s")
    report = editor.wait("saved", lambda r: r["saved"])
    with open(report["file"]) as file:
        return json.load(file)


def step_after(editor, action, what):
    """Does something that is one step of undo."""
    step = editor.report()["step"]
    action()
    editor.wait(what, lambda r: r["step"] == step + 1)


def rows(editor):
    """Names of the bookmarks as they are listed."""
    controls = editor.report()["controls"]
    names = [c.removeprefix("bookmarks/") for c in controls if c.startswith("bookmarks/")]
    return sorted(names, key=lambda name: controls["bookmarks/" + name][1])


def bookmarks_are_kept_gone_to_and_renamed(editor):
    FIRST.update(saved_scene(editor))
    check("bookmarks" not in FIRST, "a scene without bookmarks says nothing of them")
    editor.click("world/Camera")
    step_after(editor, lambda: editor.key("ctrl+b"), "a bookmark by key")
    step_after(editor, lambda: editor.key("KP_7"), "the camera looks from above")
    step_after(editor, lambda: editor.click("inspector/add_bookmark"), "a bookmark by mouse")
    above = saved_scene(editor)["camera"]
    step_after(editor, lambda: editor.key("ctrl+1"), "the first bookmark by key")
    check(saved_scene(editor)["camera"] == FIRST["camera"], "the camera is where it was at first")
    step_after(editor, lambda: editor.click("bookmarks/view 2"), "the second bookmark by mouse")
    check(saved_scene(editor)["camera"] == above, "the camera is above")

    time.sleep(0.5)  # or this click would make the next a double one
    editor.click("bookmarks/view 2", times=2)
    step_after(editor, lambda: editor.enter("from above"), "another name")
    check(saved_scene(editor)["bookmarks"] == {"view": FIRST["camera"], "from above": above}, "both are in the file")


def bookmarks_change_places_and_go(editor):
    step_after(editor, lambda: drag_down(editor, "bookmarks/view", 24), "another order")
    editor.wait("it shows", lambda r: rows(editor) == ["from above", "view"])
    check(list(saved_scene(editor)["bookmarks"]) == ["from above", "view"], "the file has that order")

    editor.point_at("bookmarks/view")
    editor.display.xdotool("click", 3)
    step_after(editor, lambda: editor.click("bookmark/Set to the present view"), "a bookmark of what is seen now")
    kept = saved_scene(editor)
    check(kept["bookmarks"]["view"] == kept["camera"], "it is what is seen now")
    editor.point_at("bookmarks/view")
    editor.display.xdotool("click", 3)
    step_after(editor, lambda: editor.click("bookmark/Delete"), "one less")
    editor.wait("the other is left", lambda r: rows(editor) == ["from above"])
    while editor.report()["step"] > 0:
        step = editor.report()["step"]
        editor.key("ctrl+z")
        editor.wait("a step back", lambda r: r["step"] == step - 1)
    check(saved_scene(editor) == FIRST, "undo takes back all of it")


def drag_down(editor, control, by):
    x, y = editor.point_at(control, 0.2)
    editor.display.xdotool("mousedown", 1)
    for step in range(1, 9):
        editor.display.xdotool("mousemove", x, y + by * step // 8)
        time.sleep(0.03)
    editor.display.xdotool("mouseup", 1)


def halves(editor):
    """The pixels of parts in the picture's left and right quarter that nothing is drawn over."""
    x, y, width, height = editor.place("viewport")
    part = (width // 5, height // 3)
    top, margin = y + height // 2, width // 10
    return [editor.display.picture(left, top, *part) for left in (x + margin, x + width - margin - part[0])]


def shows(editor, half, picture, what):
    editor.wait(what, lambda _: changed_fraction(halves(editor)[half], picture[half]) < 0.01)


def the_split_view_compares(editor):
    """Left is what the settings say, right another look; both as they are where nothing is split."""
    revision = editor.report()["revision"]
    editor.key("8")  # depth has no noise
    editor.wait("depth", lambda r: r["view"] == "Depth")
    editor.settled()
    depth = halves(editor)
    editor.key("7")
    editor.wait("normals", lambda r: r["view"] == "Normals")
    editor.settled()
    normals = halves(editor)
    check(min(map(changed_fraction, depth, normals)) > 0.2, "the two views differ")

    editor.key("v")
    editor.click("split/b")
    editor.click("split/view")
    editor.click("split/view/Depth")
    editor.key("Escape")
    editor.wait("both", lambda r: r["view"] == "Normals" and r["beside"] == "Depth")
    shows(editor, 0, normals, "left of the divider are normals")
    shows(editor, 1, depth, "right of it is depth")

    editor.drag("split/divider", to_fraction(editor, 0.05))
    shows(editor, 0, depth, "the divider was dragged to the left: depth is there too")
    editor.drag("split/divider", to_fraction(editor, 0.95))
    shows(editor, 1, normals, "and to the right: normals are there too")
    check(editor.report()["revision"] == revision, "none of this changes the scene")
    editor.click("tools/split")
    editor.wait("one picture", lambda r: "split/divider" not in r["controls"])
    editor.key("1")
    editor.settled()


def to_fraction(editor, fraction):
    """Pixels from the divider to a place in the picture."""
    x, _, width, _ = editor.place("viewport")
    divider = editor.place("split/divider")
    return int(x + fraction * width - divider[0] - divider[2] / 2)


def materials_are_assigned(editor):
    """By a click beside the name, by a drop on the picture, and a new one from the inspector; all is undone."""
    def material(name):
        nodes = saved_scene(editor)["root"]["children"]
        return next(node for node in nodes if node["name"] == name).get("material")

    check(material("short block") is None and material("back wall") is None, "neither has one")
    editor.click("tree/short block")
    x, y, width, height = editor.place("materials/red")
    editor.display.xdotool("mousemove", x + width - 20, y + height // 2)
    time.sleep(0.3)
    step_after(editor, lambda: editor.display.xdotool("click", 1), "red by a click")
    check(material("short block") == "red", "the selected one has it")

    left, top, width, height = editor.place("viewport")
    x, y = editor.point_at("materials/green", 0.2)
    editor.display.xdotool("mousedown", 1)
    for part in range(1, 11):
        editor.display.xdotool("mousemove", x + (left + width // 2 - x) * part // 10,
                               y + (top + int(0.3 * height) - y) * part // 10)
        time.sleep(0.05)
    step_after(editor, lambda: editor.display.xdotool("mouseup", 1), "green by a drop")
    check(material("back wall") == "green", "what it was dropped on has it")

    editor.click("inspector/material")
    step_after(editor, lambda: editor.click("material/new"), "a new material")
    editor.wait("it is shown", lambda r: r["selection"] == "material")
    check(material("short block") == "material", "and is that of the node")
    for _ in range(3):
        step = editor.report()["step"]
        editor.key("ctrl+z")
        editor.wait("a step back", lambda r: r["step"] == step - 1)
    check(saved_scene(editor) == FIRST, "undo takes back all of it")


def main():
    run_steps(sys.argv[1], sys.argv[2],
              [bookmarks_are_kept_gone_to_and_renamed, bookmarks_change_places_and_go, the_split_view_compares,
               materials_are_assigned],
              "view_window_failure.png")


if __name__ == "__main__":
    run_test(main)
