// The reference solutions against the tables they were published with: every printed digit.

#include "support/reference_shock.hpp"

#include <gtest/gtest.h>

namespace {

using namespace poreshock::reference;

/// The value rounds to the number printed with `digits` decimals.
void expect_printed(double value, double printed, int digits, const char* what, double row) {
  EXPECT_NEAR(value, printed, 0.5 * std::pow(10.0, -digits) * (1.0 + 1e-9))
      << what << " at " << row;
}

TEST(ReferenceShock, SolidHugoniotWithoutStrength) {
  struct Row {
    double up, us, rho, P, T, T_res, surface, V_res;
  };
  constexpr Row rows[] = {
      {300, 5752, 2848.57, 4.6591, 336.414, 302.155, 600.15, 1.00014},
      {500, 6020, 2944.57, 8.1270, 368.129, 309.156, 1000.74, 1.00058},
      {700, 6288, 3038.22, 11.8843, 410.369, 323.134, 1402.05, 1.00147},
      {900, 6556, 3129.63, 15.9311, 466.735, 345.387, 1804.38, 1.00289},
      {1000, 6690, 3174.52, 18.0630, 501.269, 359.868, 2005.99, 1.00381},
      {1100, 6824, 3218.87, 20.2673, 540.567, 376.662, 2207.93, 1.00487},
      {1200, 6958, 3262.70, 22.5439, 585.009, 395.800, 2410.23, 1.00608},
      {1300, 7092, 3306.01, 24.8929, 634.962, 417.291, 2612.91, 1.00743},
      {1500, 7360, 3391.13, 29.8080, 752.793, 467.296, 3019.43, 1.01056},
      {2000, 8030, 3595.52, 43.3620, 1166.914, 631.603, 4043.02, 1.02070},
      {3000, 9370, 3971.59, 75.8970, 2623.148, 1102.460, 6121.74, 1.04865},
  };
  const Solid m = fluid_of({});
  for (const Row& r : rows) {
    const State s = hugoniot(m, r.up);
    expect_printed(s.front, r.us, 0, "Us", r.up);
    expect_printed(s.density(), r.rho, 2, "density", r.up);
    expect_printed(s.pressure / 1e9, r.P, 4, "pressure", r.up);
    expect_printed(s.temperature, r.T, 3, "temperature", r.up);
    const Released released = release(m, s);
    expect_printed(released.temperature, r.T_res, 3, "residual temperature", r.up);
    expect_printed(released.surface_velocity, r.surface, 2, "surface velocity", r.up);
    expect_printed(released.volume * m.density, r.V_res, 5, "residual volume", r.up);
    // T V^gamma is constant on an isentrope.
    EXPECT_NEAR(
        released.temperature / s.temperature * std::pow(released.volume / s.volume, m.gamma), 1.0,
        1e-9);
  }
}

TEST(ReferenceShock, PistonWithoutStrengthIsTheHugoniot) {
  const Solid m = fluid_of({});
  for (const double up : {100.0, 1100.0, 3000.0}) {
    const State a = hugoniot(m, up);
    const Piston p = piston(m, up);
    EXPECT_FALSE(p.two_waves);
    EXPECT_NEAR(p.shocked.front, a.front, 1e-9 * a.front);
    EXPECT_NEAR(p.shocked.pressure, a.pressure, 1e-9 * a.pressure);
    EXPECT_NEAR(p.shocked.energy, a.energy, 1e-9 * a.energy);
    EXPECT_NEAR(p.shocked.temperature, a.temperature, 1e-7);
  }
}

TEST(ReferenceShock, PrecursorAndOverdrivenLimit) {
  const Solid m;
  const State y = yield_point(m);
  expect_printed(y.front, 6451.8, 1, "front", 0);
  expect_printed(y.stress / 1e6, 259.66, 2, "stress", 0);
  expect_printed(y.velocity, 14.906, 3, "velocity", 0);
  expect_printed(y.density(), 2706.252, 3, "density", 0);
  expect_printed(y.pressure / 1e6, 179.66, 2, "pressure", 0);
  expect_printed(y.deviator() / 1e6, 80.0, 1, "deviator", 0);
  expect_printed(y.temperature, 301.39, 2, "temperature", 0);
  const double limit = overdriven_above(m);
  expect_printed(limit, 805.2, 1, "limit", 0);
  EXPECT_TRUE(piston(m, limit * 0.999).two_waves);
  EXPECT_FALSE(piston(m, limit * 1.001).two_waves);
  expect_printed(piston(m, limit).shocked.stress / 1e9, 14.03, 2, "stress", limit);
}

TEST(ReferenceShock, ElasticPistonStaysBelowYield) {
  const Solid m;
  const Piston p = piston(m, 10.0);
  EXPECT_TRUE(p.elastic);
  EXPECT_FALSE(p.two_waves);
  EXPECT_EQ(p.shocked.plastic_strain, 0.0);
  EXPECT_NEAR(p.shocked.velocity, 10.0, 1e-9);
  // Slower than the precursor at yield, faster than sound: c_L = 6436.8 m/s.
  EXPECT_GT(p.shocked.front, longitudinal_speed(m, m.volume(), 0.0));
  EXPECT_LT(p.shocked.front, yield_point(m).front);
  expect_printed(longitudinal_speed(m, m.volume(), 0.0), 6436.8, 1, "sound", 0);
}

TEST(ReferenceShock, PistonWithStrength) {
  struct Row {
    double up;
    bool two_waves;
    double front, rho, P, stress, s, strain, T;
  };
  constexpr Row rows[] = {
      {100, true, 5510.5, 2748.815, 1.44257, 1.52522, 82.65, .01035, 311.54},
      {300, true, 5777.4, 2847.111, 4.61700, 4.70562, 88.62, .03366, 337.54},
      {500, true, 6044.3, 2943.033, 8.08076, 8.17500, 94.24, .05564, 369.88},
      {700, true, 6311.3, 3036.662, 11.83389, 11.93346, 99.56, .07642, 412.43},
      {900, false, 6576.9, 3128.053, 15.87718, 15.98178, 104.60, .09609, 469.12},
      {1000, false, 6709.2, 3172.921, 18.00783, 18.11485, 107.02, .10554, 503.95},
      {1100, false, 6841.8, 3217.256, 20.21090, 20.32027, 109.37, .11474, 543.54},
      {1300, false, 7107.8, 3304.364, 24.83430, 24.94822, 113.91, .13247, 638.52},
      {1500, false, 7374.2, 3389.452, 29.74740, 29.86563, 118.23, .14933, 756.91},
      {2000, false, 8041.8, 3593.774, 43.29753, 43.42570, 128.17, .18816, 1172.36},
  };
  const Solid m;
  for (const Row& r : rows) {
    const Piston p = piston(m, r.up);
    const State& s = p.shocked;
    EXPECT_EQ(p.two_waves, r.two_waves) << r.up;
    EXPECT_NEAR(s.velocity, r.up, 1e-9 * r.up);
    expect_printed(s.front, r.front, 1, "front", r.up);
    expect_printed(s.density(), r.rho, 3, "density", r.up);
    expect_printed(s.pressure / 1e9, r.P, 5, "pressure", r.up);
    expect_printed(s.stress / 1e9, r.stress, 5, "stress", r.up);
    expect_printed(s.deviator() / 1e6, r.s, 2, "deviator", r.up);
    expect_printed(s.plastic_strain, r.strain, 5, "plastic strain", r.up);
    expect_printed(s.temperature, r.T, 2, "temperature", r.up);
  }
}

TEST(ReferenceShock, ReleaseWithStrength) {
  struct Row {
    double up, surface, surface_kinematic, T, T_kinematic, head;
  };
  constexpr Row rows[] = {
      {300, 596.48, 597.13, 305.82, 305.40, 7156},
      {500, 996.64, 997.71, 314.66, 313.64, 7639},
      {700, 1397.57, 1399.02, 330.21, 328.42, 8122},
      {900, 1799.57, 1801.37, 354.05, 351.36, 0},
      {1000, 2001.06, 2003.02, 369.43, 366.25, 0},
      {1100, 2202.90, 2205.01, 387.11, 383.42, 9080},
      {1300, 2607.67, 2610.06, 429.51, 424.75, 0},
      {1500, 3014.02, 3016.66, 481.27, 475.37, 10021},
      {2000, 4037.27, 4040.42, 649.91, 641.00, 11162},
  };
  const Solid isotropic;
  Solid kinematic;
  kinematic.kinematic_share = 1.0;
  for (const Row& r : rows) {
    const State s = piston(isotropic, r.up).shocked;
    const Released a = release(isotropic, s);
    const Released b = release(kinematic, s);
    expect_printed(a.surface_velocity, r.surface, 2, "surface velocity", r.up);
    expect_printed(b.surface_velocity, r.surface_kinematic, 2, "the same, kinematic", r.up);
    expect_printed(a.temperature, r.T, 2, "residual temperature", r.up);
    expect_printed(b.temperature, r.T_kinematic, 2, "the same, kinematic", r.up);
    if (r.head > 0) expect_printed(release_head(isotropic, s), r.head, 0, "head", r.up);
  }
}

// Published with other codes: ExactPack's elastic-plastic piston and the copper piston count the
// elastic energy in the equation of state, the Wilkins plate does not.
TEST(ReferenceShock, PublishedPistons) {
  const Solid exactpack{2790, 5330, 1.34, 2, 880, 300, 28.6e9, .26e9, 0, 0, true};
  const Piston a = piston(exactpack, 100);
  expect_printed(a.precursor.density(), 2802.7107, 4, "ExactPack rho_y", 100);
  expect_printed(a.precursor.pressure / 1e9, .364661, 6, "ExactPack P_y", 100);
  expect_printed(a.precursor.front, 6520.660, 3, "ExactPack D_el", 100);
  expect_printed(a.precursor.velocity, 29.5721, 4, "ExactPack u_y", 100);
  expect_printed(a.shocked.density(), 2839.2268, 4, "ExactPack rho", 100);
  expect_printed(a.shocked.pressure / 1e9, 1.445555, 6, "ExactPack P", 100);
  expect_printed(a.shocked.front, 5505.528, 3, "ExactPack D_pl", 100);

  const Solid copper{8930, 3940, 1.49, 2, 385, 300, 45e9, .09e9, 0, 0, true};
  const Piston b = piston(copper, 20);
  expect_printed(b.precursor.front, 4722.2, 1, "copper D_el", 20);
  expect_printed(b.precursor.velocity, 4.7198, 4, "copper u_y", 20);
  expect_printed(b.precursor.pressure / 1e6, 139.03, 2, "copper P_y", 20);
  expect_printed(b.shocked.front, 3976.96, 2, "copper D_pl", 20);
  expect_printed(b.shocked.density(), 8973.453, 3, "copper rho", 20);
  expect_printed(b.shocked.pressure / 1e6, 681.59, 2, "copper P", 20);

  const Solid plate{2785, 5328, 1.338, 2, 884, 300, 27.6e9, .3e9, 0, 0, false};
  const Piston c = piston(plate, 400);
  expect_printed(c.precursor.front, 6484.9, 1, "plate D_el", 400);
  expect_printed(c.precursor.stress / 1e6, 634.8, 1, "plate HEL", 400);
  expect_printed(c.shocked.stress / 1e9, 6.63602, 5, "plate stress", 400);
  expect_printed(c.shocked.pressure / 1e9, 6.43602, 5, "plate P", 400);
  expect_printed(c.shocked.density(), 2985.62, 2, "plate rho", 400);
  expect_printed(c.shocked.front, 5909.2, 1, "plate D_pl", 400);
  expect_printed(c.shocked.temperature, 354.5, 1, "plate T", 400);
}

TEST(ReferenceShock, SnowPlow) {
  struct Row {
    double porosity, up, us, P, v, T, v_res, T_res, surface;
  };
  constexpr Row rows[] = {
      {.077, 500, 4026.8, 5.0176, .94890, 428.6, 1.00520, 381.9, 823.2},
      {.077, 700, 4721.3, 8.2361, .92279, 519.0, 1.00851, 434.5, 1210.3},
      {.077, 900, 5261.2, 11.8003, .89809, 628.2, 1.01225, 494.5, 1603.9},
      {.077, 1100, 5718.9, 15.6772, .87503, 758.5, 1.01644, 562.1, 2001.3},
      {.077, 1300, 6128.2, 19.8537, .85359, 912.7, 1.02108, 637.8, 2401.7},
      {.077, 1500, 6507.1, 24.3245, .83368, 1093.4, 1.02617, 721.6, 2804.5},
      {.3, 500, 1625.5, 1.5361, .98915, 446.7, 1.00822, 430.0, 604.2},
      {.3, 700, 2229.3, 2.9493, .97999, 584.0, 1.01533, 544.1, 896.4},
      {.3, 900, 2799.0, 4.7612, .96923, 763.3, 1.02389, 684.0, 1210.3},
      {.3, 1100, 3336.3, 6.9361, .95756, 983.0, 1.03350, 843.9, 1541.4},
      {.3, 1300, 3844.4, 9.4457, .94549, 1242.5, 1.04383, 1019.4, 1885.8},
      {.3, 1500, 4327.7, 12.2689, .93342, 1541.3, 1.05466, 1207.3, 2240.9},
      {.46, 500, 1085.1, .7910, .99852, 442.9, 1.00849, 434.2, 554.1},
      {.46, 700, 1516.7, 1.5479, .99715, 580.0, 1.01621, 558.4, 804.5},
      {.46, 900, 1946.1, 2.5536, .99542, 762.6, 1.02595, 717.9, 1069.9},
      {.46, 1100, 2372.9, 3.8056, .99339, 990.8, 1.03733, 908.6, 1348.9},
      {.46, 1300, 2796.9, 5.3012, .99111, 1264.3, 1.05003, 1126.4, 1640.1},
      {.46, 1500, 3218.0, 7.0378, .98866, 1583.2, 1.06373, 1367.6, 1942.3},
      {.6, 1100, 1849.5, 2.1972, 1.01313, 977.0, 1.03858, 929.7, 1243.9},
  };
  const Solid m = fluid_of({});
  for (const Row& r : rows) {
    const State s = snow_plow(m, r.porosity, r.up);
    const double row = 1000 * r.porosity + 1e-4 * r.up;
    expect_printed(s.front, r.us, 1, "Us", row);
    expect_printed(s.pressure / 1e9, r.P, 4, "P", row);
    expect_printed(s.volume * m.density, r.v, 5, "V/V0", row);
    expect_printed(s.temperature, r.T, 1, "T", row);
    const Released released = release(m, s);
    expect_printed(released.volume * m.density, r.v_res, 5, "released V/V0", row);
    expect_printed(released.temperature, r.T_res, 1, "residual T", row);
    expect_printed(released.surface_velocity, r.surface, 1, "surface velocity", row);
    // The closed form: P = P_H (2V - gamma (V0 - V)) / (2V - gamma (V00 - V)).
    const double v0 = m.volume(), v00 = v0 / (1.0 - r.porosity), v = s.volume;
    const double closed =
        curve_pressure(m, v) * (2 * v - m.gamma * (v0 - v)) / (2 * v - m.gamma * (v00 - v));
    if (v < v0) {
      EXPECT_NEAR(s.pressure, closed, 1e-9 * closed);
    }
  }
  EXPECT_NEAR(hugoniot(m, 900).volume, snow_plow(m, 0.0, 900).volume, 1e-12 * m.volume());
}

TEST(ReferenceShock, CrushCurve) {
  struct Row {
    double porosity, threshold, work, left100, left200, left300;
    int digits100, digits200, digits300;
  };
  constexpr Row rows[] = {{.077, 177.6, 20.4, .0076, 0, 0, 4, 4, 4},
                          {.3, 83.4, 60.5, .173, .022, 3e-4, 3, 3, 4},
                          {.46, 53.8, 88.5, .333, .115, .015, 3, 3, 3}};
  const Solid m;
  for (const Row& r : rows) {
    const double alpha = 1.0 / (1.0 - r.porosity);
    expect_printed(crush_pressure(m.yield, alpha) / 1e6, r.threshold, 1, "threshold", r.porosity);
    expect_printed(crush_work(m.yield, alpha) / 1e6, r.work, 1, "work", r.porosity);
    expect_printed(crush(m, r.porosity, 100).porosity(), r.left100, r.digits100, "100", r.porosity);
    expect_printed(crush(m, r.porosity, 200).porosity(), r.left200, r.digits200, "200", r.porosity);
    expect_printed(crush(m, r.porosity, 300).porosity(), r.left300, r.digits300, "300", r.porosity);
    // Below the threshold nothing closes; the two functions are inverse to each other.
    EXPECT_EQ(crushed_distension(m.yield, 0.99e6 * r.threshold, alpha), alpha);
    const double half = 1.0 + 0.5 * (alpha - 1.0);
    EXPECT_NEAR(crushed_distension(m.yield, crush_pressure(m.yield, half), alpha), half, 1e-12);
    // The work is the area under the crush curve.
    constexpr int n = 20000;
    double area = 0.0;
    for (int i = 0; i < n; ++i) {
      area += crush_pressure(m.yield, 1.0 + (alpha - 1.0) * (i + 0.5) / n) * (alpha - 1.0) / n;
    }
    EXPECT_NEAR(area, crush_work(m.yield, alpha), 1e-4 * area);
  }
  // Well above the threshold the voids are gone and the snow plow holds.
  EXPECT_NEAR(crush(m, .3, 700).state.front, snow_plow(m, .3, 700).front, 0.1);
}

}  // namespace
