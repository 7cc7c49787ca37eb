"""Tables, plots and pages from the rows of experiments, and the fit of the verdict's probability.

`experiments/analyse --help` says how to use it, experiments/README.md what there is to analyse.
"""
