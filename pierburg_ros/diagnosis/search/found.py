"""What a search has found: the chosen explanation with its last values, and the fits that it is held against."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

from pierburg_ros.deadline import Deadline
from pierburg_ros.diagnosis.search.beam import Beam
from pierburg_ros.diagnosis.search.needed import needed
from pierburg_ros.diagnosis.search.pruning import pruned
from pierburg_ros.diagnosis.search.rivals import fit_rivals
from pierburg_ros.diagnosis.search.search import Resigned, Search
from pierburg_ros.diagnosis.search.selection import adequate, overlooks
from pierburg_ros.diagnosis.search.supported import Beside
from pierburg_ros.diagnosis.search.together import recalibrated
from pierburg_ros.diagnosis.search.tried import Progress, Tried
from pierburg_ros.estimation.data import Data, with_validation
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.explanation import Explanation, jumps
from pierburg_ros.estimation.intervals import Estimate, lowest_with_estimates
from pierburg_ros.estimation.refinement import lowered
from pierburg_ros.plant import Model
from pierburg_ros.workers import workers

GROWING = 0.7
"""Share of the time that the search may take; the rest is for last values, what remains, and limits. Chosen: without a
limit these took 5 to 40 % of it; not varied."""


@dataclass(frozen=True)
class Found:
    """All explanations tried, each with its best fit, and what the choice among them needs.

    `chosen` is the preferred one, `final` the same with its last values and `estimates` their intervals, by dotted
    name; `recalibrated` is the nominal structure with its parameters fitted again. `exhausted`: the search ended
    because its budget of candidates was spent. `beside` is what the recordings say counted against what remains, None
    where it has not come to that. `needless` are effects that would account for all, and are not needed.
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
        """The fits of explanations of `size` quantities."""
        return [fit for fit in self.fits.values() if fit.explanation.size == size]

    @property
    def estimator(self) -> Estimator:
        """Fits to the training samples."""
        return Estimator(self.data, self.nominal)


def search(
    data: Data,
    nominal: Model,
    progress: Progress = lambda _: None,
    jobs: int | None = None,
    beam: Beam | None = None,
    deadline: Deadline | None = None,
) -> Found:
    """Search what `nominal` lacks in `data`, `jobs` fits at a time.

    Where an effect shows only in samples that validate, the search is made again with these training as well. At the
    `deadline`, or after Ctrl-C, what has been found by then is taken; without one all is tried, however little it
    promises.
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
            # a search that was stopped may not have come to it
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
    """The search with its rivals fitted; each search is added to those `begun` at once, for who cannot wait."""
    with suppress(Resigned), workers(jobs, deadline) as pool:
        begun.append(Search(data, nominal, pool, progress, beam))
        if overlooks(begun[-1].run(), begun[-1].whole):
            begun.append(Search(with_validation(data), nominal, pool, progress, beam))
            begun[-1].run()
        if not begun[-1].resigned:
            fit_rivals(begun[-1], begun[-1].preferred())
            pruned(begun[-1])
    return begun[-1]


def _checked(progress: Progress, deadline: Deadline, begun: Sequence[Search]) -> Progress:
    """`progress` that ends with the time, and says how far the last search `begun` is."""
    done = 0

    def tell(what: str) -> None:
        nonlocal done
        deadline.check()
        done += 1
        searching = begun[-1]
        searching.check()
        searching.waiting = max(searching.waiting - 1, 0)
        ratios = [fit.ratio for fit in list(searching.fits.values())]
        best = f"error {min(ratios):.3g} times the noise" if ratios else ""
        left = None if math.isinf(deadline.left) else deadline.left
        progress(Tried(what, "missing physics", done, done + searching.waiting, best, left))

    return tell


def settled_on(found: Found, fit: Fit, jobs: int | None, deadline: Deadline) -> Found:
    """`found` with a `fit` that accounts for all chosen in the end, with last values where time is left for them."""
    chosen = replace(found, fits={**found.fits, fit.explanation: fit}, chosen=fit)
    final, known = deadline.attempt(lambda: _last_values(chosen, jobs, deadline), (fit, dict[str, Estimate]()))
    return replace(chosen, final=final, estimates=known)


def _last_values(found: Found, jobs: int | None, deadline: Deadline) -> tuple[Fit, dict[str, Estimate]]:
    """The chosen explanation fitted to all samples but those that test, and its intervals.

    Where events jump, minima near by are searched, unless the search has looked further: a fit may reach the noise in
    one that is not the lowest. Far away there is none that is lower by more than chance.
    """
    chosen = found.chosen
    with workers(jobs, deadline) as pool:
        estimator = Estimator(with_validation(found.data), found.nominal, pool.map)
        fit = estimator.fit(chosen.explanation, chosen.values)
        if jumps(fit.explanation) and not chosen.refined:
            fit = lowered(estimator, fit)
        # its fits are spread over the cores, not the columns of each
        return lowest_with_estimates(Estimator(estimator.data, found.nominal), fit, pool.map)
