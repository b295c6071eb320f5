"""What other packages offer, searches and engines: found by entry points, run in processes of their own."""

from foon_asp.offered.offer import Offer as Offer
from foon_asp.offered.offer import Raised as Raised
from foon_asp.offered.offer import find_offers as find_offers
from foon_asp.offered.offer import offers_by_name as offers_by_name
from foon_asp.offered.process import ask_offered as ask_offered
