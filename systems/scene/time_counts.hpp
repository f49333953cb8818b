#pragma once
/// \file
/// How many steps and frames a scene asks for, and whether that can be meant.

#include "systems/scene/scene.hpp"

namespace minamo {

/// Steps of a run; none where the CFL number chooses them. [1]
std::optional<double> steps_of(const TimeScene& time);

/// Frames of a run, that of the start and that of the end among them. [1]
double frames_of(const TimeScene& time, const OutputScene& output);

/// Not more steps than a run could ever take; a remark where there are very many, or one that is longer than the run.
void check_steps(Input& time_of_scene, const TimeScene& time);

/// Not more frames and checkpoints than a disk could ever hold.
void check_output_times(Input& output_of_scene, const OutputScene& output, const TimeScene& time);

}  // namespace minamo
