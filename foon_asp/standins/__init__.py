"""Stand-ins: object nodes that may be used in place of others, as units with a price."""

from foon_asp.standins.extension import with_stand_ins as with_stand_ins
