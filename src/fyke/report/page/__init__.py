"""The report: one HTML page that needs nothing but itself."""

from .page import Origin, write_report

__all__ = ["Origin", "write_report"]
