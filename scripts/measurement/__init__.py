"""What the measuring scripts are made of.

scripts/accuracy has one module for each section of docs/accuracy.md; faults.py belongs to scripts/fault_campaign; base_build.py,
columns.py, indicator_runs.py, indicator_summary.py and row_comparison.py to scripts/change_indicator. programs.py, where the
built programs are, serves other scripts as well.
"""
