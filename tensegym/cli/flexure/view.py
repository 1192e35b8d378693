"""`tensegym flexure view`: a hinge that bends under sliders, in the browser."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated

import tyro

from tensegym.cli.options import Within
from tensegym.cli.view import tell
from tensegym.flexure.models.joint_fit import fit_joint
from tensegym.report import Report

from .hinge_options import BoxOptions, HingeOptions


@dataclass(frozen=True)
class View:
    """Serve a page on this machine with a hinge under a force and a moment from sliders: finite elements, potential and
    the paper's models beside one another, their error live. Ctrl-C ends it."""

    hinge: tyro.conf.Positional[str]
    """A preset or a TOML file."""
    options: HingeOptions = field(default_factory=HingeOptions)
    box: BoxOptions = field(default_factory=BoxOptions)
    elements: Annotated[int, Within(1, 1000)] = 16
    """Beam elements a leaf of length L."""
    port: Annotated[int, Within(0, 65535)] = 8080
    """To listen on; 0: any that is free."""
    host: str = "127.0.0.1"
    """Address to listen on: this machine alone, unless another one is given."""

    def run(self) -> Report:
        from tensegym.view.hinge_view import HingeView
        from tensegym.view.page import Page

        hinge = self.options.apply(self.hinge)
        with Page("tensegym flexure", self.host, self.port) as page:
            joint = fit_joint(hinge, **self.box.ranges(), held_out=0, elements=self.elements)
            view = HingeView(page, hinge, joint, self.elements)
            tell(page)
            view.run()
        return Report("", {"url": page.url})
