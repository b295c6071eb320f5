"""Limits on the size of certificates and on the steps of their check."""

from typing import NamedTuple


class CertificateLimits(NamedTuple):
    """Limits on certificates, which may come from strangers; a certificate beyond a limit is refused.

    Attributes:
        letters: Characters of the file.
        brackets: Lists and objects in the file.
        steps: Steps of the check. To look at a unit is one step; arithmetic takes more.
        steps_each: Additional steps for each unit and object node of the network.
        rules: Rules of a claim.
        rule_steps: Steps counted for a rule, multiplied by the number of units and object nodes.
        digits: Characters of a fraction in the file.
        sum_bits: Bits of a sum of fractions.
        product_bits: Bits of a product of rates.
        written_bits: Bits of the cost of a tree, since Python writes numbers of up to 4,300 digits.
    """

    letters: int = 16_000_000
    brackets: int = 1_000_000
    steps: int = 5_000_000
    steps_each: int = 200
    rules: int = 100
    rule_steps: int = 10
    digits: int = 2_000
    sum_bits: int = 40_000
    product_bits: int = 250_000
    written_bits: int = 13_000


ALLOWED = CertificateLimits()
