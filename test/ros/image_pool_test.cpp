#include "image_pool.h"

#include <gtest/gtest.h>

using namespace uav_landing;

namespace {

TEST(ImagePool, MemoryIsUsedAgainOnceNobodyHoldsIt) {
  ImagePool pool(2);
  auto image = pool.take();
  image->data.resize(1000);
  const uint8_t* memory = image->data.data();
  image.reset();
  EXPECT_EQ(pool.take()->data.data(), memory);
}

TEST(ImagePool, WhatIsHeldIsNotGivenOut) {
  ImagePool pool(2);
  const auto first = pool.take(), second = pool.take();
  EXPECT_NE(first.get(), second.get());
}

TEST(ImagePool, AMessageMayOutliveThePool) {
  auto pool = std::make_unique<ImagePool>(1);
  auto image = pool->take();
  pool.reset();
  image->data.resize(10);
  image.reset();
}

}  // namespace
