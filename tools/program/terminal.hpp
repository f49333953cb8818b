#pragma once
/// \file
/// Where the program's words go: a terminal, its width, the line at its foot that changes; a pipe that nobody reads.

#include <cstddef>
#include <string>

namespace minamo {

/// Whether stderr is a terminal on which a line can be written over.
bool has_foot();

/// Of the terminal now: it may be resized at any time. 80 where it does not tell.
std::size_t columns_of_terminal();

/// Shows a line at the foot of the terminal in place of the one before. It can be written over only as long as it does
/// not fill the last column. That it cannot be written, as after a hang-up, is no error.
/// \pre has_foot()
void show_at_foot(const std::string& line);

/// Takes that line away. To be called before anything else is written to stderr.
void clear_foot();

/// Whether stdout is a pipe that nobody reads any more.
bool reader_has_gone();

}  // namespace minamo
