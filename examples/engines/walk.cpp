// A character walks to a goal: WalkNet at stride 1 by onnxruntime's C++ API, and nothing else.
//
//     g++ -std=c++17 -O2 -I HEADERS walk.cpp -o walk -L LIBRARIES -lonnxruntime
//     ./walk walknet.portable.onnx walk_history.npy 2 6 0.4 300 walk.f32
//
// walk_history.npy are the 30 frames before, as in the test vectors (python -m motionrt_export vectors). The result is
// float32, 219 numbers a frame at 30 fps: 24 rotations row by row, each local to its parent, and the pelvis in metres.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include <onnxruntime_cxx_api.h>

constexpr int64_t kHistory = 30, kWidth = 219;
constexpr int kJoints = 24, kRoot = 9 * kJoints;
using Frame = std::array<double, kWidth>;
using Matrix = std::array<double, 9>;

struct Goal {
  double x, z, heading;
};

Matrix Multiply(const Matrix& a, const double* b) {
  Matrix out{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) out[3 * i + j] += a[3 * i + k] * b[3 * k + j];
  return out;
}

// Turns pelvis and place about the vertical axis; heights stay.
Frame Turned(Frame frame, double yaw) {
  const double c = std::cos(yaw), s = std::sin(yaw);
  const Matrix pelvis = Multiply({c, 0, s, 0, 1, 0, -s, 0, c}, frame.data());
  std::copy(pelvis.begin(), pelvis.end(), frame.begin());
  const double x = frame[kRoot], z = frame[kRoot + 2];
  frame[kRoot] = c * x + s * z;
  frame[kRoot + 2] = c * z - s * x;
  return frame;
}

Frame ToGoal(Frame frame, const Goal& goal) {
  frame[kRoot] -= goal.x;
  frame[kRoot + 2] -= goal.z;
  return Turned(frame, -goal.heading);
}

Frame FromGoal(const Frame& seen, const Goal& goal) {
  Frame frame = Turned(seen, goal.heading);
  frame[kRoot] += goal.x;
  frame[kRoot + 2] += goal.z;
  return frame;
}

// The nearest rotation: the polar factor, by Newton's iteration X <- (X + X^-T) / 2.
void Orthonormalise(double* m) {
  for (int step = 0; step < 30; ++step) {
    Matrix c;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int a = (i + 1) % 3, b = (i + 2) % 3, p = (j + 1) % 3, q = (j + 2) % 3;
        c[3 * i + j] = m[3 * a + p] * m[3 * b + q] - m[3 * a + q] * m[3 * b + p];
      }
    const double determinant = m[0] * c[0] + m[1] * c[1] + m[2] * c[2];
    if (!(determinant > 1e-9)) throw std::runtime_error("the model predicts no rotation: check the history");
    double change = 0;
    for (int i = 0; i < 9; ++i) {
      const double next = (m[i] + c[i] / determinant) / 2;
      change = std::max(change, std::abs(next - m[i]));
      m[i] = next;
    }
    if (change < 1e-15) return;
  }
}

class Walker {
 public:
  Walker(const std::string& model, std::vector<Frame> history) : history_(std::move(history)) {
    Ort::SessionOptions options;
    options.SetIntraOpNumThreads(1);
    session_ = Ort::Session(env_, model.c_str(), options);
  }

  // The next frame (1/30 s) in the world.
  Frame Step(const Goal& goal, float speed) {
    std::vector<float> seen;
    for (const Frame& frame : history_)
      for (double value : ToGoal(frame, goal)) seen.push_back(static_cast<float>(value));
    const std::array<int64_t, 3> shape{1, kHistory, kWidth};
    const std::array<int64_t, 1> one{1};
    const auto memory = Ort::MemoryInfo::CreateCpu(OrtArenaAllocator, OrtMemTypeDefault);
    std::array<Ort::Value, 2> inputs{
        Ort::Value::CreateTensor<float>(memory, seen.data(), seen.size(), shape.data(), shape.size()),
        Ort::Value::CreateTensor<float>(memory, &speed, 1, one.data(), one.size())};
    const char* takes[] = {"frames", "speed"};
    const char* gives[] = {"next"};
    auto found = session_.Run(Ort::RunOptions{nullptr}, takes, inputs.data(), inputs.size(), gives, 1);
    const float* next = found[0].GetTensorData<float>();
    Frame frame;
    std::copy(next, next + kWidth, frame.begin());
    for (int joint = 0; joint < kJoints; ++joint) Orthonormalise(&frame[9 * joint]);
    frame = FromGoal(frame, goal);
    history_.erase(history_.begin());
    history_.push_back(frame);
    return frame;
  }

 private:
  Ort::Env env_{ORT_LOGGING_LEVEL_ERROR, "walk"};
  Ort::Session session_{nullptr};
  std::vector<Frame> history_;
};

// A (30, 219) float32 matrix as NumPy writes it.
std::vector<Frame> ReadHistory(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  const size_t size = kHistory * kWidth * sizeof(float);
  if (bytes.size() < size + 10 || bytes[1] != 'N') throw std::runtime_error(path + " is no .npy file of 30 frames");
  const float* values = reinterpret_cast<const float*>(bytes.data() + bytes.size() - size);
  std::vector<Frame> history(kHistory);
  for (Frame& frame : history)
    for (double& value : frame) value = *values++;
  return history;
}

int main(int count, char** given) try {
  if (count != 8) {
    std::fprintf(stderr, "usage: walk MODEL.onnx HISTORY.npy X Z HEADING FRAMES OUT.f32\n");
    return 2;
  }
  const Goal goal{std::atof(given[3]), std::atof(given[4]), std::atof(given[5])};
  Walker walker(given[1], ReadHistory(given[2]));
  std::ofstream out(given[7], std::ios::binary);
  for (int i = 0; i < std::atoi(given[6]); ++i)
    for (double value : walker.Step(goal, 1.2f)) {
      const float single = static_cast<float>(value);
      out.write(reinterpret_cast<const char*>(&single), sizeof single);
    }
  return out ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 1;
}
