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


def loading(found):
    """When the loading ends, and how much is hot then."""
    end = 1e9 * found.time[found.end]
    verdict, why = judged(near(end, 750.0, 0.05), "5 mm in 750 ns is 6670 m/s, hardly slower than the solid (6824 m/s); with "
                          "7.7 % of voids that collapse the snow-plow Hugoniot gives 5719 m/s, 874 ns.")
    claims = [Claim("Loading ends at about 750 ns", f"{end:.0f} ns", verdict, why)]
    for rise, wanted in ((100, 1.0), (150, 0.82), (200, 0.31), (250, 0.07)):
        area = found.at("A", rise)[found.end]
        verdict, why = judged(abs(area - wanted) <= 0.05, "The plastic heat of collapsing voids grows with resolution and depends "
                              "on void size and scheme, which the paper does not state.", abs(area - wanted) <= 0.15)
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
    loaded = slice(found.end // 4, found.end + 1)
    largest = float(numpy.max(numpy.abs(found.at("chi_paper", 150)[:found.end + 1])))
    low = [float(numpy.max(numpy.abs(found.at("chi_paper", rise)[:found.end + 1]))) / largest for rise in (50, 100)]
    claims = [Claim("chi near 0 at 50 and 100 K on loading", f"at most {low[0]:.2f} and {low[1]:.2f} of the largest |chi(150 K)|",
                    *judged(max(low) <= 0.2, "At 100 K cold spots beside voids count.", max(low) <= 0.5))]
    falls = measures.rank_correlation(found.at("chi_paper", 150)[loaded])
    last = found.at("chi_paper", 150)[found.end]
    claims.append(Claim("chi(150 K) becomes ever more negative on loading",
                        f"{last:+.2e} at its end, rank correlation with time {falls:+.2f}",
                        *judged(last < 0.0 and falls < -0.8, "Cold domains join or vanish once most of the sample is hotter than "
                                "the threshold, so their number falls again before loading ends.", last < 0.0 or falls < -0.5)))
    for rise in (200, 250):
        rises = measures.rank_correlation(found.at("chi_paper", rise)[loaded])
        last = found.at("chi_paper", rise)[found.end]
        claims.append(Claim(f"chi({rise} K) rises on loading", f"{last:+.2e} at its end, rank correlation with time {rises:+.2f}",
                            *judged(last > 0.0 and rises > 0.8, "With more than half of the area hotter than the threshold, hot "
                                    "spots merge and cold spots count.", last > 0.0 or rises > 0.5)))
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


def exponent(points):
    """n of DT ~ V^n through the points (velocity, mean, deviation)."""
    velocity, mean, _ = (numpy.array(column, dtype=float) for column in zip(*points))
    known = numpy.isfinite(mean) & (mean > 0.0)
    fit = measures.straight_line(numpy.log(velocity[known]), numpy.log(mean[known]))
    return fit.slope if fit else numpy.nan


def growth(low, high):
    """Growth of the matching threshold with the velocity: series of Figure 7 at both void fractions."""
    lines = {level: measures.straight_line(*(numpy.array(column) for column in
                                             zip(*[(v**2 / 1e4, mean) for v, mean, _ in points]))) for level, points in high.items()}
    quality = [fit.quality for fit in lines.values() if fit]
    worst = min(quality) if quality else numpy.nan
    claims = [Claim("At 0.46 DT grows as V^2 (parabola)", f"straight lines in V^2 explain at least {100 * worst:.1f} % of the variance",
                    *judged(worst >= 0.99, "d_p is flat around its minimum where little is hotter than the threshold, so that the match "
                            "of one sample is uncertain.", worst >= 0.95))]
    steep = [float(numpy.mean([exponent(points) for points in series.values()])) for series in (low, high)]
    claims.append(Claim("At low porosity DT grows faster", f"DT ~ V^{steep[0]:.2f} at 0.077, V^{steep[1]:.2f} at 0.46 (mean of the levels)",
                        *judged(steep[0] > steep[1], "Relative growth is compared.")))
    return claims


def power_law(series, fits, reading):
    """The power law of Figure 8 and its end; `reading` says at which times the runs were compared."""
    known = {level: fit for level, fit in fits.items() if fit}
    rises = [measures.rank_correlation([mean for _, mean, _ in points if numpy.isfinite(mean)]) for points in series.values()
             if sum(numpy.isfinite(mean) for _, mean, _ in points) > 2]
    why = ("At common times the slower shock in more porous material has heated less of it, and only a low threshold makes up "
           "for that." if reading == "common times" else "In this thermal model plastic work is the only heat besides compression, and "
           "compression falls as the void fraction grows; how much plastic work there is depends on cell, void size and scheme.")
    up = sum(rise > 0.0 for rise in rises)
    claims = [Claim(f"DT grows with the void fraction ({reading})", f"for {up} of {len(rises)} levels",
                    *judged(bool(rises) and up == len(rises), why, up > 0))]
    text = "; ".join(f"{level} K: exponent {fit.slope:+.2f} up to {last:g}, {100 * fit.quality:.1f} % of the variance"
                     for level, (fit, last) in known.items())
    good = bool(known) and all(fit.quality >= 0.95 and fit.slope > 0.0 for fit, _ in known.values())
    claims.append(Claim(f"DT ~ porosity^n in some range ({reading})", text or "no range of three points",
                        *judged(good, why, any(fit.slope > 0.0 for fit, _ in known.values()))))
    broken = [level for level, (fit, last) in known.items() if last < series[level][-1][0]]
    claims.append(Claim(f"It breaks at high porosity ({reading})",
                        f"breaks within the range for {', '.join(f'{level} K' for level in broken) or 'no level'}",
                        *judged(bool(broken) and len(broken) == len(known), "", bool(broken))))
    return claims


def fit_range(points, tolerance=0.1):
    """Power law through the first points, as many as it describes within `tolerance` each; (fit, last porosity)."""
    known = [(porosity, mean) for porosity, mean, _ in points if numpy.isfinite(mean) and mean > 0.0]
    for count in range(len(known), 2, -1):
        x, y = (numpy.log(numpy.array(column)) for column in zip(*known[:count]))
        fit = measures.straight_line(x, y)
        if numpy.max(numpy.abs(y - fit.start - fit.slope * x)) <= tolerance:
            return fit, known[count - 1][0]
    return None
