"""Draws runs for print: strips of particles, histories, times of the systems, and a movie.

  tools/figures out/dam_break                      into out/dam_break/figures
  tools/figures out/dam_break out/honey            the same, runs side by side, into the first folder
  tools/figures out/dam_break --times 0.1,0.3,0.6 --field vorticity
  tools/figures out/dam_break_3d --slice y=0.05
  tools/figures out/splash --render --times 0.08   water in a tank, by Blender, of runs with "surface": "ply"
  tools/figures readme                             the pictures of the README; runs the scene if its results are missing
  tools/figures results                            those of scenes/RESULTS.md, in the same way
  tools/figures paper                              the figures of scenes/paper, in the same way
  tools/figures gallery                            the pictures of scenes/GALLERY.md, in the same way
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

import numpy as np

from figuring.documents import DOCUMENTS, write_pictures
from figuring.fields import find_field, usual_fields
from figuring.layout import WIDTH, png
from figuring.movies import check_ffmpeg, write_movie
from figuring.plots import draw_history, draw_systems
from figuring.rendering import Rendering, render
from figuring.scene_runs import ROOT
from figuring.strips import Strip, draw_strip
from figuring.views import Slice, check_slice, read_slice
from reporting.closed_pipes import readers_may_go
from reporting.references import read_references
from reporting.runs import NoResults, Run, telling_times


def numbers(text: str) -> list[float]:
    """Numbers with commas between them."""
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"expected numbers with commas between them, got \"{text}\"") from None


def slice_(text: str) -> Slice:
    """`z=0.1`."""
    try:
        return read_slice(text)
    except ValueError as problem:
        raise argparse.ArgumentTypeError(str(problem)) from None


def words(text: str) -> list[str]:
    """Words with commas between them."""
    return text.split(",")


def positive(text: str) -> int:
    """A whole number above 0."""
    if not text.isdigit() or int(text) == 0:
        raise argparse.ArgumentTypeError(f"expected a whole number above 0, got \"{text}\"")
    return int(text)


def pixels(text: str) -> tuple[int, int]:
    """`900x600`."""
    width, _, height = text.partition("x")
    return positive(width), positive(height)


def angles(text: str) -> tuple[float, float]:
    """`-25,20`."""
    found = numbers(text)
    if len(found) != 2 or not -90 <= found[1] <= 90:
        raise argparse.ArgumentTypeError(f"expected two angles, the second from -90 to 90 degrees, got \"{text}\"")
    return found[0], found[1]


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="tools/figures", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", metavar="DIR", help="what `minamo run --out DIR` wrote")
    parser.add_argument("--out", type=Path, metavar="DIR", help="default: `figures` in the first DIR")
    parser.add_argument("--times", type=numbers, metavar="T,T,...",
                        help="output times to show [s]; default: 6, between which the liquid moves equally far")
    parser.add_argument("--field", type=words, metavar="NAME,NAME,...",
                        help="a strip for each; the movie shows the first; default: speed,pressure, and fluid "
                             "before them where there are several liquids; what is no finite number is magenta")
    parser.add_argument("--slice", type=slice_, metavar="AXIS=PLACE",
                        help="of a run in 3-D: particles within half a cell of a plane [m], like z=0.1")
    parser.add_argument("--reference", type=Path, metavar="DIR",
                        help="draws the lines of DIR/NAME_tT.csv (segment,x,y) into the strips at time T")
    parser.add_argument("--corners", action="store_true",
                        help="draws how the corners of boxes of liquid, free of walls, must go: on straight lines "
                             "with the velocity of the start, as for the rotating square")
    parser.add_argument("--fps", type=positive, metavar="N", help="frames per second; default: a movie of 6 s")
    parser.add_argument("--no-movie", action="store_true", help="pictures only")
    parser.add_argument("--render", action="store_true",
                        help="of the first run, in 3-D: pictures of its surface by Blender, and nothing else; of "
                             "every frame, or of those of --times")
    parser.add_argument("--size", type=pixels, default=(900, 600), metavar="WxH", help="of these; default: 900x600")
    parser.add_argument("--eye", type=angles, default=(-24.0, 16.0), metavar="A,E",
                        help="where they are seen from: degrees to the right of the front, and above the floor; "
                             "default: -24,16, written --eye=-24,16")
    parser.add_argument("--samples", type=positive, default=128, metavar="N", help="rays per pixel; default: 128")
    return parser.parse_args()


def document_arguments(name: str) -> argparse.Namespace:
    pictures = DOCUMENTS[name]
    parser = argparse.ArgumentParser(prog=f"tools/figures {name}", description=f"Draws {pictures.about}.")
    parser.add_argument("--scenes", type=Path, default=pictures.folder, metavar="DIR",
                        help=f"default: {pictures.folder.relative_to(ROOT)}")
    parser.add_argument("--results", type=Path, default=ROOT / "out", metavar="DIR",
                        help="finished runs of the same scenes are taken from here, others are run; default: out")
    where = "the folder of the scenes" if pictures.beside == "." else f"{pictures.beside} in the folder of the scenes"
    parser.add_argument("--out", type=Path, metavar="DIR", help=f"default: {where}")
    return parser.parse_args(sys.argv[2:])


def read_run(folder: str) -> Run:
    """A run that has at least one frame."""
    run = Run(folder)
    run.require_whole()
    if len(run.times) == 0:
        raise NoResults(f"{folder}: no frames to draw; expected: at least one in fields.h5")
    return run


def figures(options: argparse.Namespace) -> None:
    """All figures of some runs."""
    runs = [read_run(folder) for folder in options.folders]
    if options.render:
        how = Rendering(options.size, options.samples, options.eye)
        for picture in render(runs[0], options.times, how, options.out or runs[0].folder / "figures"):
            print(picture)
        return
    for run in runs if options.slice else []:
        check_slice(run, options.slice)
    if not options.no_movie:
        check_ffmpeg()
    fields = [find_field(runs, name) for name in options.field or usual_fields(runs)]
    references = read_references(options.reference) if options.reference else []
    for run in runs if references else []:
        if run.dimension == 3:
            raise NoResults(f"{run.folder}: the lines of {options.reference} lie in 2-D, this run in 3-D")
    longest = max(runs, key=lambda run: run.times[-1])
    times = options.times or telling_times(longest, 6 if len(runs) == 1 else 4)
    strips = [draw_strip(Strip(runs, times, field, references, options.corners, options.slice)) for field in fields]

    out = options.out or runs[0].folder / "figures"
    out.mkdir(parents=True, exist_ok=True)
    suffix = "_" + options.slice.name.replace(" = ", "").removesuffix(" m") if options.slice else ""
    pictures = {f"{field.name}{suffix}": strip for field, strip in zip(fields, strips)}
    pictures |= {"history": draw_history(runs, WIDTH), "systems": draw_systems(runs, WIDTH)}
    for name, picture in pictures.items():
        if picture:
            (out / f"{name}.png").write_bytes(png(picture))
            print(out / f"{name}.png")
    if not options.no_movie:
        movie = out / f"{fields[0].name}{suffix}.mp4"
        write_movie(movie, runs, fields[0], options.slice, options.fps)
        print(movie)


def document(name: str) -> None:
    """All pictures of a document."""
    options = document_arguments(name)
    out = options.out or options.scenes / DOCUMENTS[name].beside
    out.mkdir(parents=True, exist_ok=True)
    for picture in write_pictures(DOCUMENTS[name], options.scenes, options.results, out):
        print(min(str(picture), os.path.relpath(picture), key=len))


if __name__ == "__main__":
    np.seterr(all="ignore")  # runs that went beyond all numbers are drawn as well
    try:
        with readers_may_go():
            if len(sys.argv) > 1 and sys.argv[1] in DOCUMENTS:
                document(sys.argv[1])
            else:
                figures(arguments())
    except NoResults as problem:
        print(problem, file=sys.stderr)
        sys.exit(2)
