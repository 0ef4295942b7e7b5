"""The paper's claims, each with what we found and our verdict."""
from dataclasses import dataclass

import numpy

from poreshock_paper import measures

AGREES, PARTLY, DIFFERS = "agrees", "partly", "differs"


@dataclass(frozen=True)
class Claim:
    """A sentence of the paper, what we found, the verdict, and why where we differ."""
    claim: str
    found: str
    verdict: str
    why: str = ""


def near(value, wanted, share):
    return bool(abs(value - wanted) <= share * abs(wanted))


def judged(good, why="", half=False):
    """Verdict and reason; a reason only where the claim is not met."""
    return (AGREES, "") if good else (PARTLY if half else DIFFERS, why)


AREAS = {100: 1.0, 150: 0.82, 200: 0.31, 250: 0.07}  # of the paper at the end of loading, by rise (K)


def loading(found, solid, variants):
    """When the loading ends, and how much is hot then; `solid` and `variants` (by name) are the runs that tell why."""
    end, end_of_solid = 1e9 * found.time[found.end], 1e9 * solid.time[solid.end]
    verdict, why = judged(near(end, 750.0, 0.05), f"A run without voids ends its loading at {end_of_solid:.0f} ns. With 7.7 % of "
                          "voids that collapse the snow-plow Hugoniot gives 874 ns.")
    claims = [Claim("Loading ends at about 750 ns", f"{end:.0f} ns", verdict, why)]
    for rise, wanted in AREAS.items():
        area = found.at("A", rise)[found.end]
        others = {name: other.at("A", rise)[other.end] for name, other in variants.items()}
        low, high = min(others, key=others.get), max(others, key=others.get)
        verdict, why = judged(abs(area - wanted) <= 0.05, f"It hangs on what the paper does not state: {others[low]:.3f} ({low}) to "
                              f"{others[high]:.3f} ({high}) among the variants below.", abs(area - wanted) <= 0.15)
        claims.append(Claim(f"A({rise} K) = {wanted:g} at the end of loading", f"{area:.3f}", verdict, why))
    return claims


def fall(found, name, rise, later=100e-9):
    """Change of a curve from the end of loading to `later` seconds after it."""
    values = found.at(name, rise)
    after = int(numpy.argmin(numpy.abs(found.time - found.time[found.end] - later)))
    return float(values[after] - values[found.end])


def areas(found):
    loaded = slice(0, found.end + 1)
    apart = float(numpy.max(numpy.abs(found.at("A", 50)[loaded] - found.at("A", 100)[loaded])))
    verdict, why = judged(apart <= 0.03, "A rim at the free top and the foot of the front stay between the two.", apart <= 0.06)
    claims = [Claim("A(50 K) and A(100 K) nearly equal on loading", f"at most {apart:.3f} apart", verdict, why)]
    drops = [fall(found, "A", rise) for rise in (50, 100)]
    verdict, why = judged(drops[1] < drops[0], "")
    claims.append(Claim("A(100 K) falls faster than A(50 K) on release", f"{drops[1]:+.3f} against {drops[0]:+.3f} in 100 ns",
                        verdict, why))
    return claims


def lengths(found):
    peak = float(numpy.max(found.at("L", 200)[:found.end + 1]))
    low = [float(numpy.max(found.at("L", rise)[:found.end + 1])) / peak for rise in (50, 100)]
    claims = [Claim("L(50 K), L(100 K) stay small on loading", f"at most {low[0]:.2f} and {low[1]:.2f} of the largest L(200 K)",
                    *judged(max(low) <= 0.35, "Measured against L(200 K), they are not small.", max(low) <= 0.6))]
    changes = {rise: fall(found, "L", rise) for rise in (50, 100, 150, 200, 250)}
    rising = changes[50] > 0.0 and changes[100] > 0.0
    falling = all(changes[rise] < 0.0 for rise in (150, 200, 250))
    text = ", ".join(f"{rise} K {change:+.4f}" for rise, change in changes.items())
    claims.append(Claim("On release L(50 K), L(100 K) rise and the others fall", f"change in 100 ns: {text}",
                        *judged(rising and falling, "Which threshold rises depends on how hot the material is at the end of "
                                "loading, that is on the areas above.", rising or falling)))
    return claims


def connectivity(found):
    """chi while loading; where it differs, what it is at the rise that leaves the paper's area hot."""
    loaded = slice(found.end // 4, found.end + 1)

    def change(rise):
        chi = found.at("chi_paper", rise)
        return chi[found.end], measures.rank_correlation(chi[loaded])

    def text(rise):
        return "{:+.2e} at its end, rank correlation with time {:+.2f}".format(*change(rise))

    def why(rise):
        alike = measures.exceeded(found, AREAS[rise])
        return (f"chi follows the hot area, here {found.at('A', rise)[found.end]:.2f} instead of {AREAS[rise]:g}. At {alike:.0f} K, "
                f"where {AREAS[rise]:g} is hot, it is {text(alike)}.")

    chi = found.arrays["chi_paper"][:found.end + 1]
    largest, most = numpy.max(numpy.abs(chi)), found.rise[int(numpy.argmax(numpy.max(numpy.abs(chi), axis=0)))]
    peaks = {rise: float(numpy.max(numpy.abs(found.at("chi_paper", rise)[:found.end + 1]))) for rise in (50, 100, 150)}
    low = [peaks[rise] / peaks[150] for rise in (50, 100)]
    claims = [Claim("chi near 0 at 50 and 100 K on loading", f"at most {low[0]:.2f} and {low[1]:.2f} of the largest |chi(150 K)|",
                    *judged(max(low) <= 0.2, f"chi(150 K) is small itself: of the largest |chi| ({largest:.1e}, at {most:.0f} K) they "
                            f"are {peaks[50] / largest:.2f} and {peaks[100] / largest:.2f}.", max(low) <= 0.5))]
    last, falls = change(150)
    claims.append(Claim("chi(150 K) becomes ever more negative on loading", text(150),
                        *judged(last < 0.0 and falls < -0.8, why(150), last < 0.0 or falls < -0.5)))
    for rise in (200, 250):
        last, rises = change(rise)
        claims.append(Claim(f"chi({rise} K) rises on loading", text(rise),
                            *judged(last > 0.0 and rises > 0.8, why(rise), last > 0.0 or rises > 0.5)))
    return claims


def release(porous, solid, found):
    """How much of the mean rise is left 150 ns after its peak, porous against solid: (times, mean rises) each."""
    def left(time, rise):
        peak = int(numpy.argmax(rise))
        return float(numpy.interp(time[peak] + 150e-9, time, rise)) / float(rise[peak])

    parts = left(*porous), left(*solid)
    return [Claim("Temperature falls more slowly on release than in the solid",
                  f"150 ns after its peak {100 * parts[0]:.0f} % of the mean rise is left, in the solid {100 * parts[1]:.0f} %",
                  *judged(parts[0] > parts[1], ""))]


def best_matches(by_velocity):
    """Best matches of 120 K at 1100 m/s: (mean, deviation) by velocity."""
    claims = []
    for velocity, wanted in ((1000, 92.0), (1200, 154.0)):
        mean, deviation = by_velocity[velocity]
        bars = max(5.0, 2.0 * deviation if numpy.isfinite(deviation) else 0.0)
        claims.append(Claim(f"Best match of 120 K at 1100 m/s is {wanted:g} K at {velocity} m/s",
                            f"{mean:.1f} K" + (f" ± {deviation:.1f} K" if numpy.isfinite(deviation) else ""),
                            *judged(abs(mean - wanted) <= bars, "Heat by compression goes with the velocity alone; the plastic "
                                    "share differs with resolution and scheme.", abs(mean - wanted) <= 2.0 * bars)))
    return claims


def exponent(series):
    """n of DT ~ V^n and its standard error, the mean of all levels; a series has points (velocity, mean, deviation)."""
    fits = []
    for points in series.values():
        velocity, mean, _ = (numpy.array(column, dtype=float) for column in zip(*points))
        known = numpy.isfinite(mean) & (mean > 0.0)
        fits.append(measures.straight_line(numpy.log(velocity[known]), numpy.log(mean[known])))
    fits = [fit for fit in fits if fit]
    if not fits:
        return numpy.nan, numpy.nan
    return numpy.mean([fit.slope for fit in fits]), numpy.sqrt(sum(fit.error**2 for fit in fits)) / len(fits)


def growth(low, high):
    """Growth of the matching threshold with the velocity: series of Figure 7 at both void fractions."""
    lines = {level: measures.straight_line(*(numpy.array(column) for column in
                                             zip(*[(v**2 / 1e4, mean) for v, mean, _ in points]))) for level, points in high.items()}
    quality = [fit.quality for fit in lines.values() if fit]
    worst = min(quality) if quality else numpy.nan
    claims = [Claim("At 0.46 DT grows as V^2 (parabola)", f"straight lines in V^2 explain at least {100 * worst:.1f} % of the variance",
                    *judged(worst >= 0.99, "d_p is flat around its minimum where little is hotter than the threshold, so that the match "
                            "of one sample is uncertain.", worst >= 0.95))]
    steep = [exponent(series) for series in (low, high)]
    texts = ["V^({:.2f} ± {:.2f})".format(*one) for one in steep]
    claims.append(Claim("At low porosity DT grows faster", f"DT ~ {texts[0]} at 0.077, {texts[1]} at 0.46 (mean of the levels)",
                        *judged(steep[0][0] > steep[1][0], "Relative growth is compared.")))
    return claims


def power_law(series, fits, reading, why):
    """The power law of Figure 8 and its end; `reading` says at which times the runs were compared."""
    known = {level: fit for level, fit in fits.items() if fit}
    rises = [measures.rank_correlation([mean for _, mean, _ in points if numpy.isfinite(mean)]) for points in series.values()
             if sum(numpy.isfinite(mean) for _, mean, _ in points) > 2]
    up = sum(rise > 0.0 for rise in rises)
    claims = [Claim(f"DT grows with the void fraction ({reading})", f"for {up} of {len(rises)} levels",
                    *judged(bool(rises) and up == len(rises), why, up > 0))]
    text = "; ".join(f"{level} K: exponent {fit.slope:+.2f} ± {fit.error:.2f} up to {last:g}, {100 * fit.quality:.1f} % of the variance"
                     for level, (fit, last) in known.items())
    good = bool(known) and all(fit.quality >= 0.95 and fit.slope > 0.0 for fit, _ in known.values())
    claims.append(Claim(f"DT ~ porosity^n in some range ({reading})", text or "no range of three points",
                        *judged(good, why, any(fit.slope > 0.0 for fit, _ in known.values()))))
    broken = [level for level, (fit, last) in known.items() if last < series[level][-1][0]]
    claims.append(Claim(f"It breaks at high porosity ({reading})",
                        f"breaks within the range for {', '.join(f'{level} K' for level in broken) or 'no level'}",
                        *judged(bool(broken) and len(broken) == len(known), "", bool(broken))))
    return claims


def heat_by_porosity(rows):
    """Why levels of Figure 8 fall or grow at own times; rows of (void fraction, end of loading, rises by share exceeded)."""
    first, last = rows[0], rows[-1]
    cooler = first[2][0.75] > last[2][0.75]
    return (f"Three quarters of the sample exceed {first[2][0.75]:.0f} K at {first[0]:g} and {last[2][0.75]:.0f} K at {last[0]:g}, a "
            f"quarter {first[2][0.25]:.0f} K and {last[2][0.25]:.0f} K (table below). Where there are more voids, "
            + ("compression heats less and their collapse more" if cooler else "compression heats little more and their collapse much more")
            + "; a level follows what heats the material that passes it.")


def loaded_by_porosity(rows):
    """The same at common times."""
    first, last = rows[0], rows[-1]
    return (f"When the shock has crossed the sample with {first[0]:g} ({1e9 * first[1]:.0f} ns), it has crossed "
            f"{100 * first[1] / last[1]:.0f} % of one with {last[0]:g}. Only a low threshold makes up for material that no shock has met.")


def fit_range(points, tolerance=0.1):
    """Power law through the first points, as many as it describes within `tolerance` each; (fit, last porosity)."""
    known = [(porosity, mean) for porosity, mean, _ in points if numpy.isfinite(mean) and mean > 0.0]
    for count in range(len(known), 2, -1):
        x, y = (numpy.log(numpy.array(column)) for column in zip(*known[:count]))
        fit = measures.straight_line(x, y)
        if numpy.max(numpy.abs(y - fit.start - fit.slope * x)) <= tolerance:
            return fit, known[count - 1][0]
    return None
