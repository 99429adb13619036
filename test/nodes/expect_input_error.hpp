#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tissue_stiffness/types/error.hpp"

/// `call` throws InputError whose text holds all of `parts`.
template <typename Call>
void expect_input_error(const Call& call, const std::vector<std::string>& parts) {
  try {
    call();
    ADD_FAILURE() << "no InputError; expected one with " << parts.front();
  } catch (const tissue_stiffness::InputError& error) {
    for (const std::string& part : parts) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << "'" << part << "' missing in: " << error.what();
    }
  }
}
