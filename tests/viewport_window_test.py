"""Handles, lights and camera in the picture, by mouse and keyboard in the editor's real window.

Usage: viewport_window_test.py FARFIELD SCENE
"""
import json
import sys
import time

from editor_driver import check, check_seen, run_steps, run_test

FIRST = {}  # the scene's file as it was


def middle(editor, control):
    x, y, width, height = editor.place(control)
    return x + width // 2, y + height // 2


def drag(editor, start, by, button=1, hold=(), before_release=lambda: None):
    """From a point of the screen, with keys held down meanwhile."""
    xdotool = editor.display.xdotool
    xdotool("mousemove", *start)
    time.sleep(0.2)  # a handle lights up
    for key in hold:
        xdotool("keydown", key)
    xdotool("mousedown", button)
    for step in range(1, 11):
        xdotool("mousemove", start[0] + by[0] * step // 10, start[1] + by[1] * step // 10)
        time.sleep(0.03)
    before_release()
    xdotool("mouseup", button)
    for key in hold:
        xdotool("keyup", key)


def saved_scene(editor):
    editor.key("ctrl+s")
    report = editor.wait("saved", lambda r: r["saved"])
    with open(report["file"]) as file:
        return json.load(file)


def node(scene, name):
    return next(child for child in scene["root"]["children"] if child.get("name") == name)


def undo_to(editor, revision):
    editor.key("ctrl+z")
    editor.wait("one step back", lambda r: r["revision"] == revision)


def remember_the_file(editor):
    FIRST.update(saved_scene(editor))


def handles_move_turn_and_scale(editor):
    """Each drag is one step, and changes what its handle says and nothing else."""
    editor.click("tree/short block")
    editor.wait("handles", lambda r: r["selection"] == "short block" and "gizmo/x" in r["controls"])
    start = node(FIRST, "short block")
    revision = editor.report()["revision"]
    for key, handle, value in (("w", "x", "translate"), ("w", "xy", "translate"), ("e", "y", "rotate"),
                               ("r", "view", "scale")):
        editor.key(key)
        drag(editor, middle(editor, "gizmo/" + handle), (45, -25))
        editor.wait(f"{value} by {handle}", lambda r: r["revision"] > revision)
        changed = node(saved_scene(editor), "short block")
        check({k for k in changed if changed[k] != start.get(k)} == {value}, f"{handle} changes {value} alone: {changed}")
        if handle == "x":
            check(changed[value][0] > start[value][0] and changed[value][1:] == start[value][1:], f"along x: {changed}")
        if handle == "xy":
            check(changed[value][2] == start[value][2] and changed[value][1] > start[value][1], f"not along z: {changed}")
        if handle == "y":
            check(changed[value][0] == changed[value][2] == 0, f"about y: {changed}")
        if value == "scale":
            check(changed[value] > 1.2, f"larger: {changed}")
        undo_to(editor, revision)
    editor.key("w")


def steps_while_ctrl_is_held(editor):
    revision = editor.report()["revision"]
    start = node(FIRST, "short block")
    drag(editor, middle(editor, "gizmo/x"), (60, 3), hold=["ctrl"])
    editor.wait("a step", lambda r: r["revision"] > revision)
    moved = node(saved_scene(editor), "short block")["translate"][0] - start["translate"][0]
    check(moved > 0.05 and abs(moved * 10 - round(moved * 10)) < 1e-3, f"moved by tenths of a metre: {moved}")
    undo_to(editor, revision)


def escape_takes_a_drag_back(editor):
    revision = editor.report()["revision"]

    def escape():
        editor.wait("it moves", lambda r: r["revision"] > revision)
        editor.key("Escape")
        editor.wait("it is back", lambda r: r["revision"] == revision)
        editor.display.xdotool("mousemove_relative", 30, 10)
        time.sleep(0.3)

    drag(editor, middle(editor, "gizmo/x"), (60, 0), before_release=escape)
    report = editor.wait("nothing has happened", lambda r: r["revision"] == revision)
    check(report["selection"] == "short block", "the selection stays")


def local_axes_and_no_handles(editor):
    """X gives the node's own axes, Q takes the handles away."""
    world = middle(editor, "gizmo/x")
    editor.key("x")
    editor.wait("another place of the handle", lambda r: abs(r["controls"]["gizmo/x"][1] + 2 - world[1]) > 3)
    editor.key("x", "q")
    editor.wait("no handles", lambda r: not any(c.startswith("gizmo/") for c in r["controls"]))
    editor.click("tools/move")
    editor.wait("handles", lambda r: "gizmo/x" in r["controls"])


def outline_follows_the_selection(editor):
    x, y, width, height = editor.place("outline")
    handle = middle(editor, "gizmo/view")
    check(x <= handle[0] <= x + width and y <= handle[1] <= y + height, "it is around the handles")
    editor.click("tree/tall block")
    editor.wait("that of the tall block",
                lambda r: r["controls"].get("outline", [0] * 4)[3] > height + 20 and r["selection"] == "tall block")
    editor.click("tree/scene")
    editor.wait("none of the whole scene", lambda r: "outline" not in r["controls"] and "gizmo/x" not in r["controls"])


def lights_are_clicked_and_moved(editor):
    revision = editor.report()["revision"]
    editor.display.xdotool("mousemove", *middle(editor, "light/lamp"), "click", 1)
    editor.wait("the lamp", lambda r: r["selection"] == "lamp" and "gizmo/x" in r["controls"])
    drag(editor, middle(editor, "gizmo/x"), (-40, 0))
    editor.wait("it moves", lambda r: r["revision"] > revision)
    first, now = FIRST["lights"]["lamp"]["position"], saved_scene(editor)["lights"]["lamp"]["position"]
    check(now[0] < first[0] and now[1:] == first[1:], f"to the left: {now}")
    undo_to(editor, revision)
    editor.key("shift+l")
    editor.click("tree/scene")
    editor.wait("no sign", lambda r: "light/lamp" not in r["controls"])
    editor.key("shift+l")
    editor.wait("the sign", lambda r: "light/lamp" in r["controls"])


def the_camera_orbits_zooms_flies_and_looks_along_axes(editor):
    """Each is one step of undo, and moves the camera alone."""
    revision = editor.report()["revision"]
    place = middle(editor, "viewport")

    def turn_wheel():
        editor.display.xdotool("mousemove", place[0] + 60, place[1] + 40, "click", 4)

    def fly():
        drag(editor, place, (25, 0), button=3, hold=["w"])

    def distance(camera):
        return sum((a - b) ** 2 for a, b in zip(camera["position"], camera["target"])) ** 0.5

    before = FIRST["camera"]
    for name, action in (("orbit", lambda: drag(editor, place, (60, 20))), ("wheel", turn_wheel), ("fly", fly),
                         ("pan", lambda: drag(editor, place, (40, 0), button=2)),
                         ("right", lambda: editor.key("KP_3")), ("above", lambda: editor.key("KP_7"))):
        action()
        editor.wait(name, lambda r: r["revision"] > revision)
        time.sleep(0.5)  # turns of the wheel that come soon are one step
        scene = saved_scene(editor)
        check({k for k in scene if scene[k] != FIRST.get(k)} == {"camera"}, f"{name} moves the camera alone")
        camera = scene["camera"]
        if name == "wheel":
            check(distance(camera) < 0.95 * distance(before), f"nearer: {camera}")
        else:
            check(abs(distance(camera) - distance(before)) < 1e-2, f"{name}: as far as before: {camera}")
        if name == "above":
            check(camera["position"][0] == camera["target"][0] and camera["position"][1] > camera["target"][1],
                  f"from above: {camera}")
        undo_to(editor, revision)


def fewer_pixels_and_a_grid_are_seen(editor):
    def coarser():
        editor.click("tools/resolution")
        editor.click("tools/resolution")
        editor.settled()

    check_seen(editor, coarser, "a quarter of the resolution")
    editor.click("tools/resolution")
    editor.settled()
    editor.key("g")
    editor.settled()
    editor.key("g")
    saved_scene(editor)


def main():
    run_steps(sys.argv[1], sys.argv[2],
              [remember_the_file, handles_move_turn_and_scale, steps_while_ctrl_is_held, escape_takes_a_drag_back,
               local_axes_and_no_handles, outline_follows_the_selection, lights_are_clicked_and_moved,
               the_camera_orbits_zooms_flies_and_looks_along_axes, fewer_pixels_and_a_grid_are_seen],
              "viewport_window_failure.png")


if __name__ == "__main__":
    run_test(main)
