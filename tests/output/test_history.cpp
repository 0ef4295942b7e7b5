// history.csv: exact header, exact numbers, and a restart that leaves no row twice.
#include "poreshock/output/history.hpp"

#include <limits>
#include <sstream>

#include "output/support.hpp"
#include "poreshock/output/info.hpp"
#include "poreshock/output/row_file.hpp"

namespace poreshock {
namespace {

using test::contains;
using test::TemporaryFolder;
using test::thrown;

const MPI_Comm world = MPI_COMM_WORLD;

const std::string plane_header =
    "time [s],step [-],dt [s],particles [-],kinetic [J/m],internal [J/m],escaped [J/m],"
    "wall_work [J/m],body_work [J/m],total [J/m],elastic [J/m],compression_work [J/m],"
    "plastic_work [J/m],viscous_heat [J/m],filter_heat [J/m],step_heat [J/m],wall_heat "
    "[J/m],contact_heat [J/m],friction_heat [J/m],"
    "conduction [J/m],momentum_x [kg/s],momentum_y [kg/s],escaped_momentum_x [kg/s],"
    "escaped_momentum_y [kg/s],wall_impulse_x [kg/s],wall_impulse_y [kg/s],body_impulse_x [kg/s],"
    "body_impulse_y [kg/s],total_momentum_x [kg/s],total_momentum_y [kg/s],wall_force [N/m],"
    "numerical_share [-],guards [-]";

HistoryRow sample_row(std::int64_t step) {
  HistoryRow row;
  row.time = static_cast<double>(step) / 3e9;
  row.step = step;
  row.dt = 1e-10;
  row.particles = 1000;
  row.kinetic = 1.0 / 3.0;
  row.conduction = -2.5;
  row.momentum = {1.0, -2.0, 4.0};
  row.escaped_momentum = {0.5, 0.25, 0.125};
  row.wall_impulse = {-0.0, 3.0, 6.0};
  row.body_impulse = {5.0, 7.0, 11.0};
  row.total_momentum = {-3.5, -11.75, -12.875};
  row.wall_force = 1e9;
  row.guards = 9;
  return row;
}

std::vector<std::string> lines(const std::string& path) {
  std::istringstream in(test::file_bytes(path));
  std::vector<std::string> result;
  for (std::string line; std::getline(in, line);) result.push_back(line);
  return result;
}

TEST(History, HeaderAndNumbers) {
  EXPECT_EQ(history_header(2, false), plane_header);
  const std::string solid = history_header(3, false);
  EXPECT_TRUE(contains(solid, "kinetic [J],")) << solid;
  EXPECT_TRUE(contains(solid, ",momentum_z [kg m/s],escaped_momentum_x [kg m/s],")) << solid;
  EXPECT_TRUE(
      contains(solid, ",total_momentum_z [kg m/s],wall_force [N],numerical_share [-],guards [-]"))
      << solid;
  EXPECT_EQ(
      history_line(sample_row(3), 2),
      "1.0000000000000001e-09,3,1e-10,1000,0.33333333333333331,0,0,0,0,0,0,0,0,0,0,0,0,0,0,-2.5,"
      "1,-2,0.5,0.25,-0,3,5,7,-3.5,-11.75,1000000000,0,9");
  EXPECT_EQ(history_line(sample_row(0), 3),
            "0,0,1e-10,1000,0.33333333333333331,0,0,0,0,0,0,0,0,0,0,0,0,0,0,-2.5,1,-2,4,"
            "0.5,0.25,0.125,-0,3,6,5,7,11,-3.5,-11.75,-12.875,1000000000,0,9");
}

TEST(History, ADomainThatMovesAddsColumns) {
  EXPECT_EQ(history_header(2, false, true),
            plane_header +
                ",handed_over [J/m],taken_in [J/m],handed_over_momentum_x [kg/s],"
                "handed_over_momentum_y [kg/s],taken_in_momentum_x [kg/s],taken_in_momentum_y "
                "[kg/s]");
  HistoryRow row = sample_row(3);
  const std::string plain = history_line(row, 2);
  row.follows = true;
  row.handed_over = 2.0, row.taken_in = 0.5;
  row.handed_over_momentum = {1.0, 3.0, 0.0}, row.taken_in_momentum = {0.0, -4.0, 0.0};
  EXPECT_EQ(history_line(row, 2), plain + ",2,0.5,1,3,0,-4");
}

TEST(History, GrainsAddColumns) {
  EXPECT_EQ(history_header(2, true),
            plane_header +
                ",contact_nodes [-],crowded_nodes [-],least_gap [m],penetration [m],"
                "momentum_residual [-]");
  HistoryRow row = sample_row(3);
  const std::string plain = history_line(row, 2);
  row.contact = {
      .nodes = 12, .crowded = 3, .least_gap = 0.5, .penetration = 0.25, .residual = 1e-16};
  EXPECT_EQ(history_line(row, 2), plain + ",12,3,0.5,0.25,9.9999999999999998e-17");
  row.contact = ContactRow{};
  row.contact->least_gap = std::numeric_limits<double>::infinity();
  EXPECT_EQ(history_line(row, 2), plain + ",0,0,inf,0,0");
}

TEST(History, RowsAreThereAtOnce) {
  const TemporaryFolder folder;
  const std::string path = folder / "history.csv";
  RowFile history(path, plane_header, world);
  history.write(history_line(sample_row(1), 2));
  history.write(history_line(sample_row(2), 2));
  // Still open: a killed run would leave these rows.
  EXPECT_EQ(lines(path), (std::vector<std::string>{plane_header, history_line(sample_row(1), 2),
                                                   history_line(sample_row(2), 2)}));
  EXPECT_EQ(test::file_bytes(path).back(), '\n');
}

TEST(History, RestartDropsLaterAndBrokenRows) {
  const TemporaryFolder folder;
  const std::string path = folder / "history.csv";
  {
    RowFile history(path, plane_header, world);
    for (const std::int64_t step : {0, 10, 20, 30})
      history.write(history_line(sample_row(step), 2));
  }
  test::rank_zero_alone([&] { std::ofstream(path, std::ios::app) << "1e-9,15,1e-1"; });
  {
    RowFile history(path, plane_header, world, 20);
    history.write(history_line(sample_row(25), 2));
  }
  const auto found = lines(path);
  ASSERT_EQ(found.size(), 5u);
  EXPECT_EQ(found[0], plane_header);
  EXPECT_EQ(found[3], history_line(sample_row(20), 2));
  EXPECT_EQ(found[4], history_line(sample_row(25), 2));
  if (rank(world) == 0) {
    const std::string text = describe(path);
    EXPECT_TRUE(contains(text, "rows      4") && contains(text, "step      25")) << text;
  }
}

TEST(History, RestartOfAnotherKindOfFileIsRefused) {
  const TemporaryFolder folder;
  const std::string path = folder / "history.csv";
  { RowFile history(path, history_header(3, false), world); }
  MPI_Barrier(world);
  const std::string text = thrown<InputError>([&] { RowFile(path, plane_header, world, 5); });
  EXPECT_TRUE(contains(text, path) && contains(text, "columns")) << text;
  RowFile fresh(folder / "fresh.csv", plane_header, world, 5);
  EXPECT_EQ(lines(folder / "fresh.csv"), (std::vector<std::string>{plane_header}));
}

TEST(History, FullDiskIsAnErrorOnAllRanks) {
  const std::string text = thrown<SystemError>([] { RowFile("/dev/full", plane_header, world); });
  EXPECT_TRUE(contains(text, "/dev/full") && contains(text, "no space left")) << text;
}

}  // namespace
}  // namespace poreshock
