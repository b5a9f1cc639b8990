"""Shell: a guided calibration in the terminal."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from app.commands.shared import Commands, add_json
from app.motion.basics import G_MPS2, InputError
from app.motion.status import GuideView


def add(commands: Commands) -> None:
    """Its options."""
    guided = commands.add_parser("calibrate", help="find a sensor's nulls and scales, without equipment")
    guided.add_argument("--source", metavar="SPEC", required=True)
    guided.add_argument(
        "--sensor", metavar="NAME", help="of a source with several (default: the first heard)"
    )
    guided.add_argument(
        "--method", choices=("fit", "report"), default="fit", help="which result is saved (default: fit)"
    )
    guided.add_argument("--gravity", metavar="M/S2", type=float, default=G_MPS2, help="of this place")
    guided.add_argument("--field", metavar="UT", type=float, help="the true strength of the field, in µT")
    guided.add_argument("--out", metavar="FILE", type=Path, help="also write it here")
    guided.add_argument("--no-save", action="store_true", help="show it only; nothing will be applied")
    add_json(guided)


def run(options: argparse.Namespace) -> int:
    """Lead through it, show what was found, keep it for the sensor."""
    from app.calibration.telling import table
    from app.calibration.words import to_json
    from app.home import calibrations
    from app.shell import calibrate

    if not 9.5 <= options.gravity <= 10.0:
        raise InputError(f"--gravity {options.gravity:g}: expected 9.5 to 10 m/s²")
    if options.field is not None and not 5.0 <= options.field <= 500.0:
        raise InputError(f"--field {options.field:g}: expected 5 to 500 µT")
    out = sys.stderr if options.json else sys.stdout
    teller = Teller(out.isatty())
    fit, report = calibrate.calibrate(
        options.source,
        options.sensor,
        lambda view: print(teller.text(view), end="", file=out, flush=True),
        options.gravity,
        options.field,
    )
    chosen = fit if options.method == "fit" else report
    text = to_json(chosen)
    print("\n" + "\n".join(table(fit, report)), file=out)
    if options.out is not None:
        try:
            options.out.write_text(text, "utf-8")
        except OSError as error:
            raise InputError(f"--out {options.out}: cannot be written: {error.strerror}") from None
    if not options.no_save:
        path = calibrations.save(chosen)
        print(f"Saved for {chosen.sensor} in {path}: applied whenever it is opened.", file=out)
    if options.json:
        print(json.dumps({"fit": json.loads(to_json(fit)), "report": json.loads(to_json(report))}))
    return 0


class Teller:
    """The guide's words as text: a line for each step, and on a terminal how far it is, in place."""

    def __init__(self, live: bool) -> None:
        self._live = live
        self._step = -1
        self._note = ""

    def text(self, view: GuideView) -> str:
        """What to print now."""
        text = ""
        if view.step != self._step and not view.done:
            self._step = view.step
            text += f"{self._clear()}{view.step + 1}/{view.steps}  {view.words}\n"
        if view.note != self._note:
            self._note = view.note
            text += f"{self._clear()}      {view.note}\n" if view.note else ""
        if self._live:
            text += f"{self._clear()}      {bar(view.held)} still   field {bar(view.coverage)}"
        return text

    def _clear(self) -> str:
        return "\r\033[K" if self._live else ""


def bar(part: float, width: int = 12) -> str:
    """``[####--------] 33 %``."""
    full = round(part * width)
    return f"[{'#' * full}{'-' * (width - full)}] {100 * part:3.0f} %"
