"""kesf: Kawabata (KES-F) measurements to fabric parameters, shell sections and finite-element predictions.

The engine is the one of the command ``kesf``: the same digits. Everything is SI unless a unit is named.

>>> import kesf
>>> sheet = kesf.characterise("kesf_data/poplin")          # measured curves to parameters
>>> section = kesf.section(sheet, poisson=0.3)             # parameters to the stiffness of a shell
>>> solution = kesf.solve("cases/seed_clamped.toml", section)
>>> solution.w_max > 0.0
True
"""

from ._errors import Failure, Finding, KesfError, KesfWarning
from ._evaluate import Evaluation, evaluate, find
from ._fabrics import Batch, Fabric, Measurement
from ._functions import (
    characterise,
    compare,
    drape,
    explain,
    export,
    read,
    run,
    section,
    solve,
    targets,
    verify,
)
from ._kesf import version as _version
from ._reports import Comparison, Curve, Run, Verification
from ._sections import Assumption, Card, Section
from ._sheets import Estimate, Sheet, Sheets
from ._solutions import Drape, Mesh, Probe, Solution
from ._table import Table

__version__ = _version()

__all__ = [
    "Assumption",
    "Batch",
    "Card",
    "Comparison",
    "Curve",
    "Drape",
    "Estimate",
    "Evaluation",
    "Fabric",
    "Failure",
    "Finding",
    "KesfError",
    "KesfWarning",
    "Measurement",
    "Mesh",
    "Probe",
    "Run",
    "Section",
    "Sheet",
    "Sheets",
    "Solution",
    "Table",
    "Verification",
    "characterise",
    "compare",
    "drape",
    "evaluate",
    "explain",
    "export",
    "find",
    "read",
    "run",
    "section",
    "solve",
    "targets",
    "verify",
]
