"""Drives the editor's real window through what can happen to files: other programs, crashes, two editors, large folders.

Usage: editor_files_test.py FARFIELD
"""
import json
import os
import random
import shutil
import sys
import tempfile
import time
from pathlib import Path

from editor_driver import PATIENCE, Display, Editor, Failure, check


class SeenEditor(Editor):
    def __exit__(self, failure, *rest):
        if failure:
            self.display.save("editor_files_failure.png")  # where ctest runs: the build folder
        super().__exit__(failure, *rest)


class Session:
    """A display, the user's folders, and editors in them."""

    def __init__(self, display, program, folder):
        self.display, self.program, self.folder = display, program, folder
        self.count = 0

    def open(self, *scene):
        """An editor that shows its window."""
        self.count += 1
        editor = SeenEditor(self.display, self.program, scene[0] if scene else None,
                            self.folder / f"report{self.count}.json")
        editor.wait("a window", lambda r: "menu/File" in r["controls"])
        editor.focus = lambda: self.focus(editor)
        editor.focus()
        return editor

    def focus(self, editor):
        windows = self.display.xdotool("search", "--all", "--onlyvisible", "--pid", editor.process.pid, "--name", "Farfield")
        self.display.xdotool("windowfocus", "--sync", windows.split()[0])

    def work(self):
        return sorted(path.suffix for path in (self.folder / "farfield" / "unsaved").iterdir())


def open_file(editor, path):
    editor.key("ctrl+o")
    editor.place("dialog/path")
    editor.enter(str(path))


def menu(editor, *entries):
    editor.click("menu/File")
    for entry in entries:
        editor.click(entry)


def add_node(editor, text):
    revision = editor.report()["revision"]
    editor.click("tree/scene")
    editor.wait("the scene", lambda r: r["selection"] == "scene")
    editor.key("a")
    editor.wait("the list", lambda r: "add/search" in r["controls"])
    editor.type(text)
    editor.key("Return")
    return editor.wait(f"a {text}", lambda r: r["revision"] > revision)


def quit(editor, status=0):
    editor.key("ctrl+q")
    check(editor.process.wait(PATIENCE) == status, "the editor ends")


def template_and_save(editor, file):
    """A new scene from a template gets its file, and the file a picture."""
    menu(editor, "menu/File/template", "menu/template/studio")
    report = editor.wait("the studio", lambda r: "tree/first shape" in r["controls"])
    check(report["saved"] and report["file"] == "", "a template is a new document")
    editor.key("ctrl+s")
    editor.place("dialog/path")
    editor.enter(str(file))
    editor.wait("saved", lambda r: r["file"] == str(file))
    thumbnails = file.parent.parent / "farfield" / "thumbnails"
    editor.wait("a thumbnail", lambda r: thumbnails.exists() and any(thumbnails.glob("*.png")))


def other_program(editor, file):
    """What a text editor writes is shown, errors are told, and nobody's work is lost."""
    text = file.read_text()
    editor.click("tree/first shape")
    before = editor.wait("the shape", lambda r: r["selection"] == "first shape")
    file.write_text(text.replace('"radius": 0.6', '"radius": 0.4'))
    report = editor.wait("a reload", lambda r: r["revision"] > before["revision"])
    check(report["saved"] and report["selection"] == "first shape", "the selection stays, and all is saved")
    editor.key("ctrl+z")
    editor.wait("the old scene", lambda r: r["revision"] == before["revision"] and not r["saved"])
    editor.key("ctrl+y")
    editor.wait("theirs again", lambda r: r["saved"])

    file.write_text(text.replace('"radius": 0.6', '"radius": -4'))
    report = editor.wait("an error", lambda r: "radius" in r["error"])
    check("first shape" in report["error"] and f"{file}:" in report["error"], "the error names line and node")
    editor.key("ctrl+s")
    editor.click("changed/cancel")
    check("-4" in file.read_text(), "saving asks before it replaces what they wrote")
    file.write_text(text)
    editor.wait("no error", lambda r: r["error"] == "" and r["saved"] and "changed/cancel" not in r["controls"])

    changed = add_node(editor, "torus")
    check(not changed["saved"], "there is unsaved work")
    file.write_text(text.replace('"radius": 0.6', '"radius": 0.5'))
    editor.click("changed/mine")
    report = editor.wait("no question", lambda r: "changed/mine" not in r["controls"])
    check(report["revision"] == changed["revision"] and not report["saved"], "mine is kept and not saved")
    file.write_text(text.replace('"radius": 0.6', '"radius": 0.45'))
    editor.click("changed/theirs")
    editor.wait("theirs", lambda r: r["saved"] and "tree/Torus" not in r["controls"])
    editor.key("ctrl+z")
    editor.wait("mine", lambda r: not r["saved"] and "tree/Torus" in r["controls"])
    editor.key("ctrl+s")
    editor.wait("saved", lambda r: r["saved"])
    check("torus" in file.read_text(), "the file has mine")


def lost_file(editor, file):
    """A file that vanishes is told of, its work is not lost; a folder that is gone is a message."""
    text = file.read_text()
    file.unlink()
    editor.wait("a message", lambda r: str(file) in r["error"] and not r["saved"])
    editor.key("ctrl+s")
    editor.wait("saved", lambda r: r["saved"] and r["error"] == "")
    check(file.read_text() == text, "the file is back")
    away = file.parent.with_name("away")
    file.parent.rename(away)
    editor.wait("a message", lambda r: str(file) in r["error"] and not r["saved"])
    editor.key("ctrl+s")
    report = editor.wait("another message", lambda r: "Save as" in r["error"])
    check("No such file" in report["error"] and not report["saved"], "it says why, and what to do")
    away.rename(file.parent)
    editor.wait("it is back", lambda r: r["saved"] and r["error"] == "")


def no_scene(editor, folder):
    """Files that are no scenes are messages."""
    before = editor.report()
    large = folder / "large.json"
    large.write_bytes(b"")
    os.truncate(large, 100_000_000)
    for file, said in ((large, "too large"), (folder / "text.json", "text.json:1"), (folder / "none.json", "")):
        if file.name == "text.json":
            file.write_text("no scene")
        open_file(editor, file)
        if said:
            editor.wait(f"a message: {said}", lambda r: said in r["error"])
            editor.click("message/dismiss")
            editor.wait("no message", lambda r: r["error"] == "")
        else:
            editor.click("dialog/cancel")
    report = editor.report()
    check(report["file"] == before["file"] and report["revision"] == before["revision"], "the scene stays")


def large_folder(editor, folder):
    """Ten thousand files are listed, searched and opened by keyboard without a pause."""
    many = folder / "many"
    many.mkdir()
    for i in range(10_000):
        (many / f"scene {i:05}.json").touch()
    shutil.copy(folder / "scenes" / "mine.json", many / "the one.json")
    editor.key("ctrl+o")
    editor.place("dialog/path")
    start = time.monotonic()
    editor.type(str(many) + "/")
    editor.key("Return")
    editor.wait("the files", lambda r: "dialog/entry/scene 00000.json" in r["controls"])
    editor.type("one")
    editor.wait("what is found", lambda r: "dialog/entry/the one.json" in r["controls"] and
                "dialog/entry/scene 00000.json" not in r["controls"])
    editor.key("Down", "Return")
    editor.wait("the file", lambda r: r["file"] == str(many / "the one.json"))
    print(f"  {time.monotonic() - start:.1f} s", flush=True)
    menu(editor, "menu/File/recent", "menu/recent/mine.json")
    editor.wait("the recent file", lambda r: r["file"].endswith("scenes/mine.json"))


def export(editor, folder):
    """The picture at hand becomes a file; what cannot be written is a message."""
    editor.wait("a picture", lambda r: r["samples"] > 0)
    for name, magic in (("picture.png", b"\x89PNG"), ("picture.exr", b"\x76\x2f\x31\x01")):
        editor.key("ctrl+e")
        editor.place("dialog/path")
        editor.wait("a text field", lambda r: r["typing"])
        editor.key("ctrl+a")
        editor.enter(str(folder / name))
        editor.wait("it is written", lambda r: name in r["notice"])
        check((folder / name).read_bytes().startswith(magic), f"{name} is such a picture")
    editor.key("ctrl+e")
    editor.wait("a text field", lambda r: r["typing"])
    editor.key("ctrl+a")
    editor.enter("/proc/picture.png")
    editor.wait("a message", lambda r: "/proc/picture.png" in r["error"])
    editor.click("message/dismiss")


def two_editors(session, editor, file):
    """A second editor neither touches the first one's work nor takes it for left behind, and says that it is there."""
    add_node(editor, "box")
    time.sleep(1.0)
    with session.open(file) as second:
        second.wait("a warning", lambda r: "another Farfield" in r["error"])
        check("recover/later" not in second.report()["controls"], "running editors are not recovered")
        add_node(second, "cone")
        second.key("ctrl+s")
        second.wait("saved", lambda r: r["saved"])
        quit(second)
    editor.focus()
    editor.click("changed/theirs")
    editor.wait("theirs", lambda r: "tree/Cone" in r["controls"] and r["saved"])


def drafts(editor, file):
    """Code that was typed and not compiled is asked about."""
    add_node(editor, "custom")
    editor.key("ctrl+s")
    editor.wait("saved", lambda r: r["saved"])
    editor.click("inspector/edit_code")
    editor.click("code_editor/text")
    editor.type("// unfinished ")
    editor.key("Escape")
    editor.wait("no text", lambda r: not r["typing"])
    editor.key("ctrl+q")
    editor.click("unsaved/cancel")
    editor.wait("no question", lambda r: "unsaved/cancel" not in r["controls"])


def kills(session, file, count):
    """Killed while it edits and saves: the file is whole, and what was done is offered and recovered, drafts too."""
    dice = random.Random(1)
    text = file.read_text()
    for turn in range(count):
        with session.open(file) as editor:
            nodes = 0
            for _ in range(dice.randint(1, 3)):
                add_node(editor, "sphere")
                nodes += 1
                if dice.random() < 0.3:
                    editor.key("ctrl+s")
            time.sleep(dice.random())
            done = editor.report()
            time.sleep(2.5 if turn == 0 else dice.random())
            editor.process.kill()
            check(turn > 0 or done["saved"] or ".work" in session.work(), "unsaved work is kept after seconds")
        spheres = json.loads(file.read_text())["root"]["children"]
        with session.open() as editor:
            if ".work" in session.work():
                editor.click("recover/open/0")
                editor.wait("the work", lambda r: r["file"] == str(file) and not r["saved"] and
                            "recover/later" not in r["controls"])
                check(not done["saved"] or len(spheres) > 0, "what was saved is in the file")
                editor.key("ctrl+s")
                editor.wait("saved", lambda r: r["saved"])
            quit(editor)
        json.loads(file.read_text())
        check(session.work() == [], f"nothing is left behind, not {session.work()}")
    file.write_text(text)


def left_work(session, file):
    """What is put off is offered again; what is discarded is not; drafts come back."""
    with session.open(file) as editor:
        editor.click("tree/Custom code")
        editor.click("inspector/edit_code")
        editor.click("code_editor/text")
        editor.type("// unfinished ")
        time.sleep(3.0)
        editor.process.kill()
    with session.open() as editor:
        editor.click("recover/later")
        editor.wait("no question", lambda r: "recover/later" not in r["controls"])
        menu(editor, "menu/File/recover")
        editor.click("recover/open/0")
        editor.wait("the work", lambda r: r["file"] == str(file))
        editor.click("tree/Custom code")
        editor.key("ctrl+q")
        editor.place("unsaved/discard")  # not compiled, still
        time.sleep(1.0)
        editor.process.kill()
    with session.open() as editor:
        editor.click("recover/discard/0")
        editor.click("recover/later")
        editor.wait("no question", lambda r: "recover/later" not in r["controls"])
        quit(editor)
    check(session.work() == [], f"nothing is left behind, not {session.work()}")
    with session.open() as editor:
        check("recover/later" not in editor.report()["controls"], "what was discarded is gone")
        quit(editor)


def remembered(session):
    """Panels are as they were left."""
    with session.open() as editor:
        left = editor.place("splitter/left")[0]
        shown = "code" in editor.report()
        editor.drag("splitter/left", by=-30)
        editor.wait("a narrower tree", lambda r: r["controls"]["splitter/left"][0] <= left - 20)
        editor.key("F4")
        editor.wait("the other way", lambda r: ("code" in r) != shown)
        left = editor.place("splitter/left")[0]
        quit(editor)
    with session.open() as editor:
        report = editor.wait("the code as it was left", lambda r: ("code" in r) != shown)
        check(abs(report["controls"]["splitter/left"][0] - left) <= 1, "the tree is as wide as before")
        quit(editor)


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory(prefix="farfield-test-") as name, Display() as display:
        folder = Path(name)
        for kind in ("CONFIG", "CACHE", "STATE"):
            display.environment[f"XDG_{kind}_HOME"] = name
        # A small window, whose pictures come soon, with much room for the tree.
        (folder / "farfield").mkdir()
        (folder / "farfield" / "editor.json").write_text('{"window": {"size": [820, 560]}, "panels": {"objects": 120}, "statistics": false}')
        scenes = folder / "scenes"
        scenes.mkdir()
        file = scenes / "mine.json"
        session = Session(display, program, folder)
        with session.open() as editor:
            for step, action in (
                    ("a template, saved", lambda: template_and_save(editor, file)),
                    ("another program", lambda: other_program(editor, file)),
                    ("a lost file", lambda: lost_file(editor, file)),
                    ("no scene", lambda: no_scene(editor, folder)),
                    ("export", lambda: export(editor, folder)),
                    ("a large folder", lambda: large_folder(editor, folder)),
                    ("two editors", lambda: two_editors(session, editor, file)),
                    ("drafts", lambda: drafts(editor, file))):
                print(f"{step} ...", flush=True)
                action()
            editor.key("ctrl+q")
            editor.click("unsaved/discard")
            check(editor.process.wait(PATIENCE) == 0, "the editor ends with status 0")
        check(session.work() == [], "a clean end leaves nothing")
        for step, action in (("kills", lambda: kills(session, file, 4)),
                             ("left work", lambda: left_work(session, file)),
                             ("remembered", lambda: remembered(session))):
            print(f"{step} ...", flush=True)
            action()
    print("all steps passed")


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit(f"FAILED: {failure}")
