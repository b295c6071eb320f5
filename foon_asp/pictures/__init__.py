"""Charts, drawings of task trees and networks, and the page of ``view``."""
