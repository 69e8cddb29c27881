"""Run the command line: python -m fyke."""

from .cli import main

main()
