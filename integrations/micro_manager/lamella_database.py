"""A query at each point: see lamella_micro.py."""
from lamella_micro import Query as MicroSimulation  # noqa: F401  (the name is the manager's)
