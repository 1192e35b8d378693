"""Data of an experiment, from pictures to a fitted joint.

    sighting.py          where the arm is in a picture of the stand; dark_shapes.py: what is dark in it
    photo.py             picture files in and out; base_frame.py: from the picture to the hinge's axes
    measured_file.py     a CSV whose header names every unit, as States
    measured_fit.py      fit_measured, fit_file: any of the models fitted to measured states
    noisy_fit.py         a potential from noisy states; noisy_prior.py: what its coefficients may be expected to be
    coefficient.py       a fitted number, how well the data know it, and why not if they do not
    measured_report.py   what a fit has to say
"""

from .measured_file import read_measured
from .measured_fit import MeasuredFit, fit_file, fit_measured
from .sighting import Sighting, sight

__all__ = ["MeasuredFit", "Sighting", "fit_file", "fit_measured", "read_measured", "sight"]
