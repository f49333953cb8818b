#pragma once
/// \file
/// What a user wants to know of a run before it begins: how large, how many steps, how much memory and disk.

#include "engine/storage/world.hpp"
#include "systems/scene/scene.hpp"
#include "tools/program/available_memory.hpp"

#include <string>

namespace minamo {

struct Outlook {
  double particles = 0;       ///< at the start [1]
  double most_particles = 0;  ///< with what may come in [1]
  double step = 0;            ///< the first [s]
  std::string limit;          ///< what makes it no longer
  double speed_of_fall = 0;   ///< at the end of the longest fall through the box, from the speed at the start [m/s]
  bool falls = false;         ///< whether a body force makes it faster
  double steps = 0;           ///< all, or how many there would be at that speed [1]
  bool steps_are_known = false;
  double frames = 0;          ///< [1]
  double frame_bytes = 0;     ///< of one [byte]
  double disk_bytes = 0;      ///< all frames, rows of the history, checkpoint [byte]
  double memory_bytes = 0;    ///< estimated [byte]
  AvailableMemory available;  ///< what the machine has of it
};

/// \pre the world was seeded with the scene, and the schedule of its step was made
Outlook outlook_of(const Scene& scene, World& world, const AvailableMemory& available);

/// A line each for grid, liquid, step, frames, memory and disk, indented.
std::string text_of(const Outlook& outlook, const Scene& scene);

/// In the unit in which it is a short number: 41.2 MB.
std::string bytes_text(double bytes);

}  // namespace minamo
