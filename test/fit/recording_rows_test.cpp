// What the rows of a free run tell.
#include "fit/recording_rows.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tissue_stiffness {
namespace {

// Five frames of two rows each, of which the last has three; two rows say nothing, one is of a force.
RecordingRows some_rows() {
  RecordingRows rows;
  rows.frames = {2, 2, 2, 2, 3};
  rows.error = (Eigen::VectorXd(11) << 1, 2, 3, 4, 0, 6, 7, 8, 9, 10, 11).finished();
  rows.predicted = (Eigen::VectorXd(11) << 1, 1, 2, 3, 5, 8, 13, 21, 34, 55, 89).finished();
  rows.used = (Eigen::VectorXd(11) << 1, 1, 1, 1, 0, 1, 1, 1, 1, 1, 0).finished();
  rows.sigma = (Eigen::VectorXd(11) << 2, 2, 2, 2, 0, 1, 1, 1, 1, 1, 0).finished();
  rows.nodes = (Eigen::VectorXi(11) << 0, 1, 2, 3, 0, kForceRow, 4, 5, 6, 7, 0).finished();
  return rows;
}

TEST(FrameRows, LieOneFrameAfterTheOther) {
  const FrameRows frames = {2, 0, 3};
  EXPECT_EQ(frames.count(), 3);
  EXPECT_EQ(frames.total(), 5);
  EXPECT_EQ(frames.before(2), 2);
  EXPECT_EQ(frames.before(3), 5);
  EXPECT_EQ(frames[1].from, 2);
  EXPECT_EQ(frames[1].size, 0);
  EXPECT_EQ(frames[2].size, 3);
  EXPECT_EQ(frames[2].end(), 5);
  EXPECT_EQ(FrameRows().total(), 0);
}

TEST(RecordingRows, AreCountedWhereTheySaySomething) {
  EXPECT_EQ(some_rows().count(), 9.0);
}

TEST(RecordingRows, MoveFromTheFirstFrame) {
  const Eigen::VectorXd expected = (Eigen::VectorXd(11) << 0, 0, 1, 2, 4, 7, 12, 20, 0, 0, 0).finished();
  EXPECT_EQ(motion_of(some_rows()), expected);
}

TEST(RecordingRows, LeaveBeyondTheNoiseWhatTheirErrorsAreBeyondOne) {
  RecordingRows rows = some_rows();
  EXPECT_NEAR(structured_squares(rows), rows.error.squaredNorm() - 9.0, 1e-12);
  rows.error *= 0.01;
  EXPECT_EQ(structured_squares(rows), 0.0);
}

TEST(RecordingRows, HaveErrorsInMetresThatLeaveOutForces) {
  const RecordingRows rows = some_rows();
  const double first = 4.0 * (1.0 + 4.0 + 9.0 + 16.0), last = 49.0 + 64.0 + 81.0 + 100.0;
  EXPECT_NEAR(rms_error(rows), std::sqrt((first + last) / 8.0), 1e-12);
  EXPECT_NEAR(noise_floor(rows), std::sqrt((4.0 * 4.0 + 4.0) / 8.0), 1e-12);
  Recording recording;
  recording.frames.resize(5);  // of which 9 * 2 / 5 is the third ninth's, and 9 * 3 / 5 the sixth's
  EXPECT_NEAR(rms_error(rows, recording, true), std::sqrt((49.0 + 64.0) / 2.0), 1e-12);
  EXPECT_NEAR(rms_error(rows, recording, false), std::sqrt((first + 81.0 + 100.0) / 6.0), 1e-12);
}

TEST(RecordingRows, OfNoLengthHaveNoError) {
  RecordingRows rows = some_rows();
  rows.used.setZero();
  EXPECT_EQ(rms_error(rows), 0.0);
  EXPECT_EQ(noise_floor(rows), 0.0);
}

}  // namespace
}  // namespace tissue_stiffness
