#pragma once
// Headers of files with numbers on a regular grid. Private to the layer.

#include <string>

#include "poreshock/files/array_file.hpp"

namespace poreshock {

/// Whether a name is that of a MetaImage (.mhd, .mha) or a NRRD (.nrrd, .nhdr) file.
bool names_volume(const std::string& path);

/// The numbers that such a header describes, of this many axes. Throws InputError with all that is
/// wrong with the header. Sources: MetaIO's documentation of MetaImage, teem's definition of the
/// NRRD format. Not collective.
StoredArray read_volume_header(const std::string& path, int dimension);

}  // namespace poreshock
