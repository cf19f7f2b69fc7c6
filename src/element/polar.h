#pragma once

namespace rhexis::element {

/// The rotation R (row-major, det +1) that maximises tr(R^T F), for any finite F: one of the maximisers where there are
/// several (F = 0 gives I), always the same one. NaN in gives NaN out. The batched closed form for one tet.
void nearest_rotation(const double (&F)[9], double (&R)[9]);

/// The same by the eigenvectors of a 4 x 4 matrix: slow and sure, for the tets that the closed form declines.
void rotation_by_eigenvectors(const double (&F)[9], double (&R)[9]);

}  // namespace rhexis::element
