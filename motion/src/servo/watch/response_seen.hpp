#pragma once

namespace rmac {

/// What the watches over a joint's response look at in one cycle: N and mm, or N·m and degrees.
struct ResponseSeen {
  double effort = 0;          ///< that acted over the last way
  double commanded = 0;       ///< that its loop asks for: a drive that tells its torque may tell less
  double position = 0;        ///< measured
  double position_set = 0;    ///< of the cycle that the position belongs to
  bool out_of_bound = false;  ///< the following error is
  bool swings = false;        ///< to and fro, by much
  bool answered = true;       ///< its drives did in this cycle: it is not what they told before
};

}  // namespace rmac
