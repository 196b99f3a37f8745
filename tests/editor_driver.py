"""Hands and eyes for tests that drive the editor's real window by mouse and keyboard on a virtual display.

The editor tells through --report where its controls are and what state it is in. Nothing here depends on how fast the
machine is: every step waits for its effect, and only a machine that stands still fails.
"""
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PATIENCE = 180  # seconds until a step that shows no effect has failed


class Failure(Exception):
    pass


def check(condition, message):
    if not condition:
        raise Failure(message)


class Display:
    """A virtual screen, gone at the end of the `with` block. Its keys do not repeat: on a busy machine any press is long."""

    def __init__(self, size="1100x680"):
        self.size = size

    def __enter__(self):
        reader, writer = os.pipe()
        self.process = subprocess.Popen(
            ["Xvfb", "-displayfd", str(writer), "-screen", "0", self.size + "x24", "-nolisten", "tcp", "-r"],
            pass_fds=[writer], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(writer)
        with os.fdopen(reader) as pipe:
            number = pipe.readline().strip()
        if not number:
            self.process.kill()
            self.process.wait()
            raise Failure("Xvfb does not start")
        self.environment = dict(os.environ, DISPLAY=":" + number, LC_ALL="C.UTF-8")
        self.environment.pop("WAYLAND_DISPLAY", None)
        self.state = tempfile.TemporaryDirectory(prefix="farfield-state-")  # what an editor remembers from another test
        self.environment["XDG_STATE_HOME"] = self.state.name
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
        self.state.cleanup()

    def xdotool(self, *arguments):
        return subprocess.run(["xdotool", *map(str, arguments)], env=self.environment, check=True,
                              capture_output=True, text=True, timeout=PATIENCE).stdout

    def picture(self, x, y, width, height):
        """The bytes of a part of the screen, three for each pixel."""
        part = f"{width}x{height}+{x}+{y}"
        return subprocess.run(["import", "-silent", "-window", "root", "-crop", part, "-depth", "8", "rgb:-"],
                              env=self.environment, check=True, capture_output=True, timeout=PATIENCE).stdout

    def save(self, file):
        subprocess.run(["import", "-silent", "-window", "root", file], env=self.environment, timeout=PATIENCE)


class Editor:
    """The program, its report, and hands to use it."""

    def __init__(self, display, program, scene, report):
        self.display, self.report_file = display, report
        self.seen = []  # every sample count that was reported, in order, until it is cleared
        files = [str(scene)] if scene else []
        self.process = subprocess.Popen([program, *files, "--report", str(report)], env=display.environment)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()

    def report(self):
        check(self.process.poll() is None, f"the editor has ended with status {self.process.returncode}")
        try:
            report = json.loads(self.report_file.read_text())
        except FileNotFoundError:
            return None
        self.seen.append(report["samples"])
        return report

    def wait(self, what, condition, patience=PATIENCE):
        """Waits until the report satisfies `condition`, and returns it."""
        end = time.monotonic() + patience
        report = None
        while time.monotonic() < end:
            report = self.report()
            if report is not None and condition(report):
                return report
            time.sleep(0.05)
        state = {key: value for key, value in (report or {}).items() if key != "controls"}
        controls = sorted((report or {}).get("controls", {}))
        raise Failure(f"waited in vain for: {what}; last state {state}; controls {controls}")

    def settled(self):
        """Waits for two more pictures, so that what was done before is in the last one."""
        time.sleep(0.1 + 4e-3 * self.report()["ui_milliseconds"])  # until the last key or click has arrived
        start = self.report()["pictures"]
        return self.wait("two more pictures", lambda r: r["pictures"] >= start + 2)

    def place(self, control):
        """The rectangle of a control, once it stands still."""
        last, since = None, time.monotonic()

        def still(report):
            nonlocal last, since
            now = report["controls"].get(control)
            if now != last:
                last, since = now, time.monotonic()
            return now is not None and time.monotonic() - since > 0.25

        return self.wait(f"control {control}", still)["controls"][control]

    def point_at(self, control, across=0.5):
        x, y, width, height = self.place(control)
        x, y = int(x + across * width), y + height // 2
        self.display.xdotool("mousemove", x, y)
        return x, y

    def click(self, control, times=1):
        self.point_at(control)
        self.display.xdotool("click", "--repeat", times, "--delay", 40, 1)

    def drag(self, control, by=0, across=0.5, to=None):
        """Presses on `control` and moves by so many pixels, or to the fraction `to` of its width."""
        x, y = self.point_at(control, across)
        if to is not None:
            left, _, width, _ = self.place(control)
            by = int(left + to * width) - x
        self.display.xdotool("mousedown", 1)
        for step in range(1, 13):
            self.display.xdotool("mousemove", x + by * step // 12, y)
            time.sleep(0.03)
        self.display.xdotool("mouseup", 1)

    def key(self, *keys):
        self.display.xdotool("key", *keys)

    def type(self, text):
        """Into the field that takes text, once there is one."""
        self.wait("a text field", lambda r: r["typing"])
        self.display.xdotool("type", "--delay", 30, "--", text)

    def enter(self, text):
        self.type(text)
        self.key("Return")

    def viewport(self):
        return self.display.picture(*self.place("viewport"))


def changed_fraction(a, b):
    """Fraction of the samples of two pictures that differ by more than a little."""
    check(len(a) == len(b) and len(a) > 0, "the pictures differ in size")
    return sum(abs(x - y) > 20 for x, y in zip(a, b)) / len(a)


def check_seen(editor, action, what):
    """`action` changes the picture, by more than noise does."""
    before, noise = editor.viewport(), 1.0
    end = time.monotonic() + PATIENCE
    while noise > 0.05 and time.monotonic() < end:  # the picture of an earlier action may still come
        editor.settled()
        before, earlier = editor.viewport(), before
        noise = changed_fraction(earlier, before)
    action()
    changed = changed_fraction(before, editor.viewport())
    check(changed > noise + 0.005, f"{what} is to be seen: {changed:.4f} of the picture changed, {noise:.4f} by noise")


def start(editor):
    report = editor.wait("a first picture", lambda r: r["pictures"] >= 2)
    check(report["error"] == "", f"the scene opens without an error, not: {report['error']}")
    check(report["structural_compiles"] == 1, "opening a scene compiles one program")
    windows = editor.display.xdotool("search", "--onlyvisible", "--name", "Farfield").split()
    editor.display.xdotool("windowfocus", windows[0])
    editor.key("F3")  # numbers that change all the time would count as a changed picture
    editor.settled()


def run_steps(program, bundled, steps, failure_picture):
    """Opens a copy of the scene `bundled` and does the steps (functions of the editor, named after what they try), then
    quits. A failed step leaves a picture of the screen where ctest runs: in the build folder."""
    with tempfile.TemporaryDirectory(prefix="farfield-test-") as folder, Display() as display:
        display.environment["XDG_CONFIG_HOME"] = display.environment["XDG_CACHE_HOME"] = folder
        scene = Path(folder) / "scene.json"
        scene.write_bytes(Path(bundled).read_bytes())
        with Editor(display, program, scene, Path(folder) / "report.json") as editor:
            for step in (start, *steps):
                print(f"{step.__name__.replace('_', ' ')} ...", flush=True)
                try:
                    step(editor)
                except Failure:
                    display.save(failure_picture)
                    raise
            editor.key("ctrl+q")
            check(editor.process.wait(PATIENCE) == 0, "the editor ends with status 0")
    print("all steps passed")


def run_test(main):
    try:
        main()
    except Failure as failure:
        sys.exit(f"FAILED: {failure}")
