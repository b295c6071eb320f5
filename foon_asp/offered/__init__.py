"""What other packages offer, searches and engines: found by entry points, run in processes of their own."""

from foon_asp.offered.offer import Offer, Raised, find_offers, offers_by_name
from foon_asp.offered.process import ask_offered

__all__ = ["Offer", "Raised", "ask_offered", "find_offers", "offers_by_name"]
