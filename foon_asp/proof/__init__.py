"""What every answer is held against: does a tree execute?"""

from foon_asp.proof.simulation import Obstacle, Simulation, Verdict, simulate, simulate_for

__all__ = ["Obstacle", "Simulation", "Verdict", "simulate", "simulate_for"]
