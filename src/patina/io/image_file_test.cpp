#include <cmath>
#include <random>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfTiledOutputFile.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "patina/core/error.h"
#include "patina/core/files.h"
#include "patina/core/scratch_folder_for_tests.h"
#include "patina/io/bitmap_file.h"
#include "patina/io/exr_file.h"
#include "patina/io/png_file.h"
#include "patina/io/stokes_exr.h"
#include "patina/spectral/colorimetry.h"

namespace patina::io {
namespace {

using ::testing::HasSubstr;

template <class Action>
std::string error_of(Action action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

// A cropped image of random Stokes vectors in three bins.
StokesImage random_image() {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    StokesImage image;
    image.width = 5, image.height = 3, image.crop_x = 2, image.crop_y = 4, image.full_width = 11, image.full_height = 9;
    image.bin_edges_nm = {400, 480, 600, 700};
    image.spectral.resize(image.pixel_count() * 12);
    image.rgb.resize(image.pixel_count() * 12);
    image.alpha.assign(image.pixel_count(), 1.0f);
    image.variance.resize(image.pixel_count() * 4);
    for (auto* values : {&image.spectral, &image.rgb, &image.variance})
        for (float& value : *values) value = uniform(random);
    for (std::size_t i = 0; i < image.pixel_count(); ++i)
        image.sample_count.push_back(static_cast<std::uint32_t>(i + 16));
    image.metadata = {{"scene", "balls.xml"}, {"a_key_that_is_longer_than_thirty_one_characters", "x"}};
    return image;
}

TEST(StokesExr, AnImageComesBackBitForBit) {
    const ScratchFolder folder;
    const StokesImage image = random_image();
    write_stokes_exr(folder / "a.exr", image, {true, true, true});
    const StokesImage back = read_stokes_exr(folder / "a.exr");
    EXPECT_EQ(back.width, image.width);
    EXPECT_EQ(back.crop_x, image.crop_x);
    EXPECT_EQ(back.crop_y, image.crop_y);
    EXPECT_EQ(back.full_height, image.full_height);
    EXPECT_EQ(back.bin_edges_nm, image.bin_edges_nm);
    EXPECT_EQ(back.spectral, image.spectral);
    EXPECT_EQ(back.rgb, image.rgb);
    EXPECT_EQ(back.alpha, image.alpha);
    EXPECT_EQ(back.variance, image.variance);
    EXPECT_EQ(back.sample_count, image.sample_count);
    EXPECT_EQ(back.metadata, image.metadata);
}

TEST(StokesExr, ChannelNamesAndAttributesAreThoseOfTheLayout) {
    const ScratchFolder folder;
    write_stokes_exr(folder / "a.exr", random_image());
    const ExrInfo info = read_exr_info(folder / "a.exr");
    for (const char* name : {"S0.440,000000nm", "S3.650,000000nm", "R", "G", "B", "A", "variance.S2", "samples"})
        EXPECT_THAT(info.channels, ::testing::Contains(name));
    EXPECT_THAT(info.channels, ::testing::Not(::testing::Contains("S0.R")));
    EXPECT_EQ(info.strings.at("spectralLayoutVersion"), "1.0");
    EXPECT_EQ(info.strings.at("polarisationHandedness"), "right");
    EXPECT_TRUE(info.strings.count("emissiveUnits"));
}

TEST(StokesExr, MitsubaImagesComeInAsColoursWithoutBins) {
    const ScratchFolder folder;
    const StokesImage image = random_image();
    write_stokes_exr(folder / "mitsuba.exr", image, {false, true, false});
    const StokesImage back = read_stokes_exr(folder / "mitsuba.exr");
    EXPECT_EQ(back.bin_count(), 0);
    EXPECT_EQ(back.rgb, image.rgb);
}

TEST(StokesExr, APlainPictureIsUnpolarized) {
    const ScratchFolder folder;
    const std::vector<float> grey{0.5f, 2.0f};
    ExrInfo info;
    info.width = info.full_width = 2, info.height = info.full_height = 1;
    write_exr(folder / "y.exr", info, {{"Y", grey.data(), nullptr, 1}});
    const StokesImage image = read_stokes_exr(folder / "y.exr");
    EXPECT_EQ(image.rgb,
              (std::vector<float>{0.5, 0.5, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 2, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(StokesExr, ColoursOfTheMissingComponentsComeFromTheBins) {
    const ScratchFolder folder;
    StokesImage image = random_image();
    // A uniform spectrum over all the CIE's wavelengths: Y = 1, and (1.205, 0.948, 0.909) in linear sRGB.
    image.bin_edges_nm = {360, 500, 600, 830};
    for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel)
        for (int bin = 0; bin < 3; ++bin) {
            const float values[] = {1.0f, 0.5f, 0.0f, -1.0f};
            std::copy_n(values, 4, image.stokes(pixel, bin));
        }
    fill_rgb_from_bins(image);
    // Three digits are what the expected figures have.
    EXPECT_NEAR(image.stokes_rgb(0)[0], 1.205, 5e-4);
    EXPECT_NEAR(image.stokes_rgb(0)[1], 0.948, 5e-4);
    EXPECT_NEAR(image.stokes_rgb(0)[2], 0.909, 5e-4);

    // The file has S0's colours only; the reader makes the others anew, to float rounding of 3 summands.
    write_stokes_exr(folder / "a.exr", image);
    const StokesImage back = read_stokes_exr(folder / "a.exr");
    for (std::size_t i = 0; i < image.rgb.size(); ++i) EXPECT_NEAR(back.rgb[i], image.rgb[i], 1e-6);
    EXPECT_NEAR(back.stokes_rgb(0)[9], -1.205, 5e-4);
}

// Mitsuba's films and most environment maps are stored in 16 bits, in tiles now and then.
TEST(StokesExr, HalfFloatTiledImagesAreRead) {
    const ScratchFolder folder;
    const std::vector<half> values{half(0.5f), half(-2.0f), half(65504.0f)};
    Imf::Header header(3, 1);
    Imf::FrameBuffer buffer;
    for (const char* name :
         {"S0.R", "S0.G", "S0.B", "S1.R", "S1.G", "S1.B", "S2.R", "S2.G", "S2.B", "S3.R", "S3.G", "S3.B"}) {
        header.channels().insert(name, Imf::Channel(Imf::HALF));
        buffer.insert(name, Imf::Slice(Imf::HALF, const_cast<char*>(reinterpret_cast<const char*>(values.data())),
                                       sizeof(half), 3 * sizeof(half)));
    }
    header.setTileDescription(Imf::TileDescription(2, 2));
    {
        Imf::TiledOutputFile file((folder / "half.exr").c_str(), header);
        file.setFrameBuffer(buffer);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    }
    const StokesImage image = read_stokes_exr(folder / "half.exr");
    for (std::size_t pixel = 0; pixel < 3; ++pixel)
        for (int i = 0; i < 12; ++i) EXPECT_EQ(image.stokes_rgb(pixel)[i], float(values[pixel]));
}

TEST(StokesExr, TruncatedAndDamagedFilesAreRefused) {
    const ScratchFolder folder;
    write_stokes_exr(folder / "a.exr", random_image(), {true, true, true});
    const std::string good = read_text_file(folder / "a.exr");
    for (std::size_t size = 0; size < good.size(); size += 37)
        EXPECT_THROW(read_stokes_exr(folder.write("cut.exr", good.substr(0, size))), Error) << size;
    std::mt19937 random(3);
    for (int copy = 0; copy < 300; ++copy) {
        std::string text = good;
        for (int edit = 0; edit < 3; ++edit) text[random() % text.size()] = static_cast<char>(random());
        try {
            read_stokes_exr(folder.write("damaged.exr", text));
        } catch (const Error&) {
        }
    }
    EXPECT_THAT(error_of([&] { read_stokes_exr(folder / "none.exr"); }), HasSubstr("file not found"));
    EXPECT_THAT(error_of([&] { read_stokes_exr(folder.write("text.exr", "hello")); }),
                HasSubstr("not a readable OpenEXR image"));
    EXPECT_THAT(error_of([&] { write_stokes_exr(folder / "no/folder/a.exr", random_image()); }),
                HasSubstr("does not exist"));
}

Bitmap ramp(int channels) {
    Bitmap image{"ramp", 16, 16, {"R", "G", "B", "A"}, {}};
    image.channels.resize(channels);
    if (channels < 3) image.channels[0] = "Y";
    for (int code = 0; code < 256; ++code)
        for (int c = 0; c < channels; ++c)
            image.data.push_back(static_cast<float>(spectral::srgb_decode(code / 255.0)));
    return image;
}

TEST(Png, EightBitCodesAreAFixedPointOfWritingAndReading) {
    const ScratchFolder folder;
    for (const int channels : {1, 3}) {
        const Bitmap image = ramp(channels);
        write_png(folder / "a.png", image, {8, false, {{"Software", "patina"}}});
        EXPECT_EQ(read_png(folder / "a.png").data, image.data);
        // Without decoding the codes themselves come back.
        EXPECT_EQ(read_png(folder / "a.png", true).data[std::size_t(channels) * 51], 0.2f);
    }
}

TEST(Png, SixteenBitsKeepFourDigits) {
    const ScratchFolder folder;
    Bitmap image = ramp(4);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = float(i) / float(image.data.size());
    write_png(folder / "a.png", image, {16, false, {}});
    const Bitmap back = read_png(folder / "a.png");
    // Half a code is 1/131070, and sRGB decodes with a slope of at most 2.3.
    for (std::size_t i = 0; i < image.data.size(); ++i) EXPECT_NEAR(back.data[i], image.data[i], 2.3 / 131070);
}

TEST(Png, BrokenFilesAndNumbersAreRefused) {
    const ScratchFolder folder;
    Bitmap image = ramp(3);
    write_png(folder / "a.png", image);
    const std::string good = read_text_file(folder / "a.png");
    for (std::size_t size = 0; size + 12 < good.size(); size += 11)
        EXPECT_THROW(read_png(folder.write("cut.png", good.substr(0, size))), Error) << size;
    std::string damaged = good;
    damaged[good.size() / 2] ^= 0x55;  // the checksum tells
    EXPECT_THROW(read_png(folder.write("damaged.png", damaged)), Error);
    image.data[3 * 17] = std::nanf("");
    EXPECT_THAT(error_of([&] { write_png(folder / "nan.png", image); }),
                HasSubstr("pixel (1, 1) is not a finite number"));
    EXPECT_FALSE(std::filesystem::exists(folder / "nan.png"));
}

std::string from_hexadecimal(std::string_view digits) {
    std::string bytes;
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
        bytes += static_cast<char>(std::stoi(std::string(digits.substr(i, 2)), nullptr, 16));
    return bytes;
}
// 16 x 8 pixels in two blocks, without loss but for rounding: grey 188 and 0; red 188 and green 255.
const std::string grey_jpeg = from_hexadecimal(
    "ffd8ffdb004300010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101"
    "01010101010101010101010101010101ffc0000b080008001001011100ffc400150001010000000000000000000000000000090bffc400"
    "14100100000000000000000000000000000000ffda0008010100003f0078121f7fffd9");
const std::string colour_jpeg = from_hexadecimal(
    "ffd8ffdb004300010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101010101"
    "01010101010101010101010101010101ffdb00430101010101010101010101010101010101010101010101010101010101010101010101"
    "010101010101010101010101010101010101010101010101010101010101ffc00011080008001003011100021101031101ffc400140001"
    "0000000000000000000000000000000affc40014100100000000000000000000000000000000ffc4001601010101000000000000000000"
    "00000000090a0bffc40014110100000000000000000000000000000000ffda000c03010002110311003f0037e3fd5e05e017d8dbbfffd9");

TEST(Jpeg, BlocksOfOneColourAreExact) {
    const ScratchFolder folder;
    const Bitmap grey = read_bitmap(folder.write("grey.jpg", grey_jpeg));
    ASSERT_EQ(grey.width, 16);
    ASSERT_EQ(grey.height, 8);
    ASSERT_EQ(grey.channels, std::vector<std::string>{"Y"});
    EXPECT_EQ(*grey.pixel(3, 2), static_cast<float>(spectral::srgb_decode(188 / 255.0)));
    EXPECT_EQ(*grey.pixel(12, 7), 0);
    EXPECT_EQ(*read_bitmap(folder / "grey.jpg", true).pixel(0, 0), static_cast<float>(188 / 255.0));

    // Luma and chroma are whole numbers: a code or two of a channel are lost.
    const Bitmap colour = read_bitmap(folder.write("colour.JPG", colour_jpeg), true);
    ASSERT_EQ(colour.channel_count(), 3);
    const float expected[2][3] = {{188, 0, 0}, {0, 255, 0}};
    for (int block : {0, 1})
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(colour.pixel(8 * block + 4, 4)[c], expected[block][c] / 255, 2.5 / 255);
}

TEST(Jpeg, BrokenFilesAreRefused) {
    const ScratchFolder folder;
    // All but the end marker is needed.
    for (std::size_t size = 0; size + 4 < grey_jpeg.size(); size += 7)
        EXPECT_THROW(read_bitmap(folder.write("cut.jpg", grey_jpeg.substr(0, size))), Error) << size;
    std::string huge = grey_jpeg;
    // Height and width in the frame header.
    const std::size_t frame = huge.find("\xff\xc0");
    ASSERT_NE(frame, std::string::npos);
    for (std::size_t i : {5, 6, 7, 8}) huge[frame + i] = '\xf0';
    EXPECT_THAT(error_of([&] { read_bitmap(folder.write("huge.jpg", huge)); }), HasSubstr("header cannot be true"));
}

TEST(BitmapFile, FloatMapsStartAtTheBottom) {
    const ScratchFolder folder;
    const float values[] = {1, 2, 3, 4};  // 2 x 2, bottom row first
    const std::string text = "Pf\n2 2\n-1.0\n" + std::string(reinterpret_cast<const char*>(values), sizeof values);
    EXPECT_EQ(read_bitmap(folder.write("a.pfm", text)).data, (std::vector<float>{3, 4, 1, 2}));
    EXPECT_THROW(read_bitmap(folder.write("b.pfm", text.substr(0, text.size() - 1))), Error);
    EXPECT_THROW(read_bitmap(folder.write("c.pfm", "Pf\n999999999 2\n-1.0\n")), Error);
}

TEST(BitmapFile, RadiancePicturesFlatAndPackedAgree) {
    const ScratchFolder folder;
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n";
    std::string flat = header, packed = header + std::string{2, 2, 0, 8};
    for (int x = 0; x < 8; ++x) flat += std::string{char(64), char(32), char(x), char(129)};
    packed += std::string{char(128 + 8), 64, char(128 + 8), 32, 8, 0, 1, 2, 3, 4, 5, 6, 7, char(128 + 8), char(129)};
    const Bitmap a = read_bitmap(folder.write("a.hdr", flat)), b = read_bitmap(folder.write("b.hdr", packed));
    EXPECT_EQ(a.data, b.data);
    // (64 + 1/2) 2^(129 - 136)
    EXPECT_EQ(a.data[0], 64.5f / 128.0f);
    for (std::size_t size = 0; size < packed.size(); ++size)
        EXPECT_THROW(read_bitmap(folder.write("cut.hdr", packed.substr(0, size))), Error) << size;
}

TEST(BitmapFile, PicturesWithImpossibleLightAreRefused) {
    const ScratchFolder folder;
    const std::vector<float> bad{0.5f, std::nanf("")}, dark{0.5f, -1.0f};
    ExrInfo info;
    info.width = info.full_width = 2, info.height = info.full_height = 1;
    write_exr(folder / "nan.exr", info, {{"Y", bad.data(), nullptr, 1}});
    write_exr(folder / "dark.exr", info, {{"Y", dark.data(), nullptr, 1}});
    EXPECT_THAT(error_of([&] { read_bitmap(folder / "nan.exr"); }), HasSubstr("pixel (1, 0) of channel Y is nan"));
    EXPECT_THROW(read_bitmap(folder / "dark.exr"), Error);
    EXPECT_NO_THROW(read_bitmap(folder / "dark.exr", true));
    EXPECT_THAT(error_of([&] { read_bitmap(folder / "a.gif"); }), HasSubstr("known: .exr"));
}

}  // namespace
}  // namespace patina::io
