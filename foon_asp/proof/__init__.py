"""What every answer is checked with: does a tree execute?"""

from foon_asp.proof.replay import Copy as Copy
from foon_asp.proof.replay import Replay as Replay
from foon_asp.proof.replay import Shortage as Shortage
from foon_asp.proof.replay import Step as Step
from foon_asp.proof.replay import replay_for as replay_for
from foon_asp.proof.simulation import Obstacle as Obstacle
from foon_asp.proof.simulation import Simulation as Simulation
from foon_asp.proof.simulation import Verdict as Verdict
from foon_asp.proof.simulation import simulate as simulate
from foon_asp.proof.simulation import simulate_for as simulate_for
