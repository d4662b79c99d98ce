"""The result of a search: the chosen explanation with its final values, and the fits that it is compared with."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from pierburg_ros.deadline import Deadline
from pierburg_ros.diagnosis.search.beam import Beam
from pierburg_ros.diagnosis.search.needed import needed
from pierburg_ros.diagnosis.search.pruning import pruned
from pierburg_ros.diagnosis.search.rivals import fit_rivals
from pierburg_ros.diagnosis.search.search import Search
from pierburg_ros.diagnosis.search.selection import overlooks
from pierburg_ros.diagnosis.search.supported import Beside
from pierburg_ros.diagnosis.search.together import recalibrated
from pierburg_ros.diagnosis.search.tried import Progress, Tried
from pierburg_ros.estimation.data import Data, with_validation
from pierburg_ros.estimation.estimator import Estimator, Fit, adequate
from pierburg_ros.estimation.intervals import Estimate, lowest_with_estimates
from pierburg_ros.estimation.refinement import lowered
from pierburg_ros.inference.explanation import Explanation, jumps
from pierburg_ros.plant import Model
from pierburg_ros.workers import workers

GROWING = 0.7
"""Share of the time that the search may take; the rest is for final values, the remainder, and limits. Chosen: without
a time limit these took 5 to 40 % of the time; not varied."""


@dataclass(frozen=True)
class Found:
    """All explanations tried, each with its best fit, and what the choice among them needs.

    `chosen` is the preferred fit. `final` is the same explanation with its final values, and `estimates` are their
    intervals, by dotted name. `recalibrated` is the nominal structure with its parameters fitted again. `exhausted`:
    the search ended because its budget of candidates was spent. `beside` is what the recordings support beside a
    remainder, None if the search did not get that far. `needless` are effects of an adequate explanation that are not
    needed.
    """

    data: Data
    nominal: Model
    drifts: tuple[str, ...]
    fits: Mapping[Explanation, Fit]
    chosen: Fit
    final: Fit
    estimates: dict[str, Estimate]
    recalibrated: Fit
    exhausted: bool
    beside: Beside | None = None
    needless: tuple[str, ...] = ()

    def of_size(self, size: int) -> list[Fit]:
        """The fits of explanations with `size` quantities."""
        return [fit for fit in self.fits.values() if fit.explanation.size == size]

    @property
    def estimator(self) -> Estimator:
        """The estimator that fits to the training samples."""
        return Estimator(self.data, self.nominal)


def search(
    data: Data,
    nominal: Model,
    progress: Progress = lambda _: None,
    jobs: int | None = None,
    beam: Beam | None = None,
    deadline: Deadline | None = None,
) -> Found:
    """Search for what `nominal` lacks in `data`, with `jobs` fits at a time.

    If an effect shows only in the validation samples, the search is repeated with these as training samples too. At the
    `deadline`, or after Ctrl-C, the result is what has been found by then. Without a deadline everything is tried,
    however little it promises.
    """
    deadline = deadline or Deadline()
    beam = beam or Beam(resigns=not math.isinf(deadline.left))
    growing = deadline.part(GROWING)
    begun = list[Search]()
    tell = _checked(progress, growing, begun)
    done = growing.attempt(lambda: _grown(data, nominal, tell, jobs, beam, growing, begun), None)
    with workers(jobs) as pool:
        found = done or (begun[0] if begun else Search(data, nominal, pool))
        found.progress = progress
        if not found.fits:
            found.add(Explanation())
        again = recalibrated(found, pool)
        if adequate(again):
            # a search that was stopped may not have tried it
            found.keep(again)
        preferred = found.preferred()
        chosen = needed(preferred, found, pool)
    result = Found(
        found.data,
        nominal,
        found.drifts,
        dict(found.fits),
        chosen,
        chosen,
        {},
        again,
        found.exhausted,
        found.beside,
        tuple(effect for effect in preferred.explanation.effects if effect not in chosen.explanation.effects),
    )
    return settled_on(result, chosen, jobs, deadline) if adequate(chosen) else result


def _grown(
    data: Data,
    nominal: Model,
    progress: Progress,
    jobs: int | None,
    beam: Beam | None,
    deadline: Deadline,
    begun: list[Search],
) -> Search:
    """The search with its rivals fitted; each search is added to `begun` at its start, for an interrupted caller."""
    with workers(jobs, deadline) as pool:
        begun.append(Search(data, nominal, pool, progress, beam))
        if overlooks(begun[-1].run(), begun[-1].whole):
            begun.append(Search(with_validation(data), nominal, pool, progress, beam))
            begun[-1].run()
        best = begun[-1].preferred()
        # what could replace an effect decides nothing if a remainder could
        if not begun[-1].resigned and needed(best, begun[-1], pool) is best:
            fit_rivals(begun[-1], best)
            pruned(begun[-1])
    return begun[-1]


def _checked(progress: Progress, deadline: Deadline, begun: Sequence[Search]) -> Progress:
    """`progress` that ends with the deadline or the search, and reports how far the last search in `begun` is."""
    done = 0

    def tell(what: str) -> None:
        nonlocal done
        deadline.check()
        done += 1
        searching = begun[-1]
        searching.waiting = max(searching.waiting - 1, 0)
        ratios = [fit.ratio for fit in list(searching.fits.values())]
        best = f"error {min(ratios):.3g} times the noise" if ratios else ""
        left = None if math.isinf(deadline.left) else deadline.left
        progress(Tried(what, "missing physics", done, done + searching.waiting, best, left))

    return tell


def settled_on(found: Found, fit: Fit, jobs: int | None, deadline: Deadline) -> Found:
    """`found` with an adequate `fit` as the final choice, and with its final values if there is time for them."""
    chosen = replace(found, fits={**found.fits, fit.explanation: fit}, chosen=fit)
    final, known = deadline.attempt(lambda: _last_values(chosen, jobs, deadline), (fit, dict[str, Estimate]()))
    return replace(chosen, final=final, estimates=known)


def _last_values(found: Found, jobs: int | None, deadline: Deadline) -> tuple[Fit, dict[str, Estimate]]:
    """The chosen explanation fitted to all samples but the test samples, and its intervals.

    If the cost has many local minima, nearby ones are searched, unless the search has looked further already. A fit may
    reach the noise in a local minimum that is not the lowest. No distant minimum is lower by more than chance.
    """
    chosen = found.chosen
    with workers(jobs, deadline) as pool:
        estimator = Estimator(with_validation(found.data), found.nominal, pool.map)
        fit = estimator.fit(chosen.explanation, chosen.values)
        if jumps(fit.explanation) and not chosen.refined:
            fit = lowered(estimator, fit)
        # the fits run in parallel, not the columns of each Jacobian
        return lowest_with_estimates(Estimator(estimator.data, found.nominal), fit, pool.map)
