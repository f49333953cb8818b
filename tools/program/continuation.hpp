#pragma once
/// \file
/// A run that goes on where it was stopped: its checkpoint, and its output as it was then.

#include "engine/storage/world.hpp"
#include "systems/output/fields_file.hpp"
#include "tools/program/scene_file.hpp"

#include <filesystem>

namespace minamo {

/// Writes checkpoint.h5. A frame that was begun and not ended is undone first.
/// \throws std::runtime_error; an older checkpoint is left as it was then.
void write_run_checkpoint(const std::filesystem::path& folder, const SceneFile& scene, World& world);

/// Sets the state to that of the folder's checkpoint. No file is changed.
/// \param scene_path  what the messages call the scene
/// \pre the components have been created.
/// \throws InputError if there is no checkpoint, if it is of another version or of a scene that differs in more than
/// `title`, `time.end` and `output`, or if the frames do not reach to it.
/// \return where they end
FieldsPosition load_checkpoint(const std::filesystem::path& folder, const std::string& scene_path,
                               const SceneFile& scene, World& world);

/// Takes the frames, history.csv and the surfaces back to the checkpoint, and goes on with them.
/// \throws InputError if the history does not reach to it.
void continue_output(const std::filesystem::path& folder, const FieldsPosition& fields, World& world);

}  // namespace minamo
