#pragma once

/// From validated values to the settings of each section: what the declaration cannot say because it takes more than
/// one key. Notes and warnings go to the scene.

#include "scene/scene.h"
#include "scene/values.h"

namespace rhexis::scene {

Expected<MeshSettings> read_mesh_section(const SectionValues& values, const std::filesystem::path& folder,
                                         Scene& scene);
/// Reads scene.model.kind.
Expected<MaterialSettings> read_material_section(const SectionValues& values, Scene& scene);
ModelChoice read_model_section(const SectionValues& values, Scene& scene);
Expected<SupportSettings> read_support(const SectionValues& values);
Expected<FractureSettings> read_fracture_section(const SectionValues& values, Scene& scene);
Expected<CrackSettings> read_crack(const SectionValues& values);
Expected<RecordSettings> read_record_section(const SectionValues& values);
Expected<InteractionSettings> read_interaction_section(const SectionValues& values,
                                                       const std::filesystem::path& folder);

/// 'mesh.size' is missing<why> (give ...).
[[nodiscard]] tl::unexpected<Error> missing(const SectionValues& values, std::string_view key, const std::string& why);
/// Warns that a key is given and has no effect: `FILE:LINE: 'model.beta' is not read by 'linear'`.
void warn_unread(const SectionValues& values, std::string_view key, const std::string& by, Scene& scene);

}  // namespace rhexis::scene
