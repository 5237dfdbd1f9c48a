"""An RVE at each point: see lamella_micro.py."""
from lamella_micro import Solve as MicroSimulation  # noqa: F401  (the name is the manager's)
