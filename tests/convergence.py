"""Shows how pictures converge: each scene's first frame of four samples, 16 and 256 samples, and the reference.

Usage: convergence.py FARFIELD PICTURE.jpg [SCENE.json...]

A row for each scene; all bundled ones by default, but for the fractals, whose reference would take hours. No window is needed.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

SCENES = Path(__file__).resolve().parent.parent / "scenes"
SIZE = "240x240"
COLUMNS = (("farfield", 1), ("farfield", 4), ("farfield", 64), ("reference", 512))  # method, frames of four samples


def main():
    program, picture = sys.argv[1:3]
    scenes = [Path(name) for name in sys.argv[3:]] or [s for s in sorted(SCENES.glob("*.json"))
                                                      if s.stem not in ("fractals", "schema")]
    with tempfile.TemporaryDirectory() as folder:
        tiles = []
        for scene in scenes:
            for method, frames in COLUMNS:
                tiles.append(f"{folder}/{len(tiles)}.png")
                subprocess.run([program, "render", scene, "-o", tiles[-1], "--size", SIZE, "--method", method,
                                "--samples", "4", "--frames", str(frames)], check=True, stdout=subprocess.DEVNULL)
        subprocess.run(["montage", *tiles, "-tile", f"{len(COLUMNS)}x", "-geometry", "+3+3", "-quality", "90", picture],
                       check=True)


main()
