"""Second engines: the same questions put to others than our solver, and what to make of it."""

from foon_asp.engines.agreement import ENGINES as ENGINES
from foon_asp.engines.agreement import Check as Check
from foon_asp.engines.agreement import agree as agree
from foon_asp.engines.agreement import cross_check as cross_check
from foon_asp.engines.agreement import find_engines as find_engines
from foon_asp.engines.engine import Asked as Asked
from foon_asp.engines.engine import DisagreementError as DisagreementError
from foon_asp.engines.engine import Engine as Engine
from foon_asp.engines.engine import EngineAnswer as EngineAnswer
from foon_asp.engines.engine import NotCheckedError as NotCheckedError
from foon_asp.engines.engine import Solve as Solve
