# SPDX-License-Identifier: Apache-2.0
"""One statement of the paper: what it says, what we find, and whether it holds."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Finding:
    """One quantity: what the paper says of it and what we compute, both as text in `unit`."""

    quantity: str
    unit: str
    paper: str
    ours: str


@dataclass(frozen=True)
class Statement:
    """
    A statement of the paper and its verdict.

    name: token; claim: in our words; where: section, equation or figure of the paper;
    confirmed: None where it holds in part; figure: draws into a fresh matplotlib Figure.
    """

    name: str
    claim: str
    where: str
    confirmed: bool | None
    reason: str
    findings: tuple[Finding, ...]
    figure: Callable | None = None
