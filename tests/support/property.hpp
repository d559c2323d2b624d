#pragma once

#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <rapidcheck.h>

/// Checks a property on random inputs. Fails the test with the counterexample that RapidCheck prints
/// (rc::check itself only returns false).
template <class Property>
void check_property(const std::string& name, Property&& property) {
  EXPECT_TRUE(rc::check(name, std::forward<Property>(property))) << name;
}
