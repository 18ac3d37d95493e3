"""Pages: one self-contained HTML file that plays a run, and one that reports a sweep."""

from sweep.pages.film import write_film
from sweep.pages.player import player_page
from sweep.pages.report import report_page

__all__ = ["player_page", "report_page", "write_film"]
