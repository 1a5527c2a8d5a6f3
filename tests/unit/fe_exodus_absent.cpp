// Goal: without NetCDF an Exodus file is refused with what to do.

#include <string>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "subdomain_solver/fe/exodus_file.hpp"

namespace abut::fe_exodus_absent_tests {
namespace {

TEST(ExodusFile, IsRefusedWithARemedyWithoutNetcdf) {
  try {
    read_exodus("part.exo");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where, "part.exo");
    EXPECT_NE(error.remedy.find("make build WITH=exodus"), std::string::npos);
  }
}

}  // namespace
}  // namespace abut::fe_exodus_absent_tests
