#include "response/response.h"

#include "base/check.h"

namespace rhexis::response {

DeformedTet Response::deformed(TetId tet) const {
  RHEXIS_CHECK(false, "tet {} of a linear body has small strains", tet.value());
}

}  // namespace rhexis::response
