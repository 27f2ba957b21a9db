"""Margins: what is measured over many poses stays well within what the contract allows."""

import numpy as np


def assert_margin(values, contract, factor=10.0, quantile=1.0):
    """Residuals or distances are a factor below what a contract allows, one bound or one for each.

    Among many random poses some are next to a singular one, where what is found is off by rounding
    over the smallest singular value: a ``quantile`` of the values keeps the factor, all of them
    the contract.
    """
    ratio = np.ravel(np.asarray(values, float) / contract)
    assert len(ratio), "nothing was measured"
    most = np.inf if np.isnan(ratio).any() else ratio.max()
    part = most if quantile == 1.0 else np.quantile(ratio, quantile)
    figures = f"of {len(ratio)} values the median is {np.median(ratio):.2g} times the contract"
    figures += f", the {quantile:.2%} quantile {part:.2g}, the maximum {most:.2g}"
    least = np.min(contract)
    assert part * factor <= 1.0, f"{figures}; the contract is {least:.2g}, the factor {factor:g}"
    assert most <= 1.0, f"{figures}; the contract is {least:.2g}"


def assert_apart(values, contract, factor=10.0, quantile=1.0):
    """Distances between what must be distinct, if any, are a factor above the contract.

    Next to a fold two solutions are as near to each other as the pose is to it: ``quantile``.
    """
    near = contract / np.maximum(np.append(values, np.inf), 1e-300)
    assert_margin(near, 1.0, factor, quantile)
