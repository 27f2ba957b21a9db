"""Where every figure of the project comes from: ours against the peers, in one run.

``python -m benchmarks`` measures and writes ``benchmarks/results/``; ``python -m benchmarks
--render`` writes the table and the plot of the README from there.
"""
