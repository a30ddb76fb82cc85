"""Runs all benchmarks, draws the plots and writes the tables of docs/results/performance.md."""
