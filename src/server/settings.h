#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "server/limits.h"

namespace rhexis::server {

struct ServerSettings {
  std::string address = "127.0.0.1";  ///< numerical; one that is not this machine's own needs a token
  std::uint16_t port = 8080;          ///< 0: any that is free
  std::string token;                  ///< asked of every visit; empty: of none
  std::filesystem::path page;         ///< folder with index.html
  std::filesystem::path recordings;   ///< folder of what Recorded names
  Limits limits;
};

}  // namespace rhexis::server
