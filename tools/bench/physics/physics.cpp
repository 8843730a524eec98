// SPDX-License-Identifier: GPL-3.0-or-later
// physics: the two scenes of section 7.3 of Tang, Lee, Kim 2009, simulated by Bullet: dominoes of 12 letters and a
// bunny of 1,000 triangles, and 50 such bunnies that fall onto each other. At every step the penetration depth of every
// pair of bodies whose boxes meet, one thread, error bound 1e-4 for models of longest side about 1.
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <memory>
#include <random>

#include "bench_main.h"
#include "measure.h"
#include "meshbound/pose.h"
#include "meshbound/scene.h"
#include "physics/bodies.h"
#include "physics/picture.h"
#include "table.h"

namespace {

using namespace meshbound;
using namespace meshbound::bench;

constexpr double error_bound = 1e-4, seconds_per_step = 1.0 / 60;

Pose pose_of(const btTransform& transform) {
  const btQuaternion q = transform.getRotation();
  const btVector3& p = transform.getOrigin();
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(p.x(), p.y(), p.z());
  pose.linear() = Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).normalized().toRotationMatrix();
  return pose;
}

/// A model as Bullet and as we see it.
struct Model {
  TriangleMesh mesh;
  ClosedModel solid;
  btTriangleMesh triangles;
  std::unique_ptr<btGImpactMeshShape> shape;

  explicit Model(TriangleMesh given) : mesh(std::move(given)), solid(mesh) {
    const auto point = [&](std::uint32_t v) {
      const Eigen::Vector3d& p = mesh.vertices[v];
      return btVector3(btScalar(p.x()), btScalar(p.y()), btScalar(p.z()));
    };
    for (const Triangle& t : mesh.triangles) triangles.addTriangle(point(t[0]), point(t[1]), point(t[2]));
    shape = std::make_unique<btGImpactMeshShape>(&triangles);
    shape->setMargin(btScalar(0));
    shape->updateBound();
  }
};

/// Bodies that fall onto the plane z = 0, in Bullet and in our scene.
class World {
 public:
  World() {
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    dynamics_.setGravity(btVector3(0, 0, btScalar(-9.81)));
    add_plane(btVector3(0, 0, 1), 0);
  }
  ~World() {
    for (const auto& body : bodies_) dynamics_.removeRigidBody(body.get());
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  void add_plane(const btVector3& normal, double offset) {
    planes_.push_back(std::make_unique<btStaticPlaneShape>(normal, btScalar(offset)));
    add_body(*planes_.back(), 0, btTransform::getIdentity());
  }

  /// The model must outlive this.
  btRigidBody& add(Model& model, const btTransform& transform) {
    models_.push_back(&model);
    scene_.add(model.solid, pose_of(transform));
    moving_.push_back(&add_body(*model.shape, 1, transform));
    return *moving_.back();
  }

  void step() {
    dynamics_.stepSimulation(btScalar(seconds_per_step), 1, btScalar(seconds_per_step));
    for (std::uint32_t i = 0; i < scene_.size(); ++i) scene_.move(i, pose_of(moving_[i]->getWorldTransform()));
  }

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const Model& model(std::uint32_t body) const { return *models_[body]; }

 private:
  btRigidBody& add_body(btCollisionShape& shape, double mass, const btTransform& transform) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(btScalar(mass), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, &shape, inertia);
    info.m_startWorldTransform = transform;
    info.m_friction = btScalar(0.4);
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
    dynamics_.addRigidBody(bodies_.back().get());
    return *bodies_.back();
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld dynamics_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btStaticPlaneShape>> planes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<btRigidBody*> moving_;
  std::vector<Model*> models_;
  Scene scene_;
};

/// What was measured over all steps.
struct Record {
  std::vector<double> touching_ms;  ///< of each pair that shares content at a step
  std::vector<double> step_ms;      ///< of each step: the boxes and all pairs
  std::uint64_t pairs = 0, skipped = 0, apart = 0;
  double deepest = 0;
};

struct Contact {
  std::uint32_t a, b;
  PenetrationDepth penetration;
};

std::vector<Contact> measure(const World& world, Record& record) {
  PenetrationOptions options;
  options.error_bound = error_bound;
  const Scene& scene = world.scene();
  std::vector<Contact> contacts;
  const Stopwatch step;
  const auto near = scene.pairs_near();
  const std::uint64_t all = std::uint64_t{scene.size()} * (scene.size() - 1) / 2;
  for (const auto& [a, b] : near) {
    const Stopwatch watch;
    PenetrationDepth found = penetration_depth({world.model(a).solid, scene.model(a).pose},
                                               {world.model(b).solid, scene.model(b).pose}, options);
    const double milliseconds = 1000 * watch.elapsed().cpu;
    if (found.volumes.empty()) {
      ++record.apart;
      continue;
    }
    record.touching_ms.push_back(milliseconds);
    record.deepest = std::max(record.deepest, found.depth.lower);
    contacts.push_back({a, b, std::move(found)});
  }
  record.step_ms.push_back(1000 * step.elapsed().cpu);
  record.pairs += all;
  record.skipped += all - near.size();
  return contacts;
}

Colour colour_of(std::uint32_t body) {
  const double hue = 2.4 * body;
  const auto shade = [&](double phase) { return static_cast<std::uint8_t>(165 + 75 * std::cos(hue + phase)); };
  return {shade(0), shade(2.1), shade(4.2)};
}

/// The bodies, and a line between the deepest points of each pair, over everything.
void draw(const World& world, const std::vector<Contact>& contacts, const Eigen::Vector3d& eye,
          const Eigen::Vector3d& target, const std::filesystem::path& path) {
  Picture picture(1200, 800, eye, target);
  for (std::uint32_t i = 0; i < world.scene().size(); ++i)
    picture.add(world.model(i).mesh, world.scene().model(i).pose, colour_of(i));
  for (const Contact& contact : contacts)
    for (const PenetrationVolume& volume : contact.penetration.volumes)
      picture.add_line(volume.on_a.position, volume.on_b.position, {200, 0, 0});
  picture.write(path);
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

double percentile_99(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() - 1 - (values.size() - 1) / 100);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// A row of the table. `paper`: the milliseconds that it reports.
void run_scene(const char* name, World& world, int steps, int frame, double paper, const Eigen::Vector3d& eye,
               const Eigen::Vector3d& target, const Options& options, Table& table) {
  Record record;
  for (int step = 0; step < steps; ++step) {
    world.step();
    const std::vector<Contact> contacts = measure(world, record);
    if (step == std::min(frame, steps - 1))
      draw(world, contacts, eye, target, options.out / (std::string("physics-") + name + ".png"));
  }
  table.rows.push_back({name, std::to_string(world.scene().size()), std::to_string(steps),
                        std::to_string(record.touching_ms.size()), format(mean(record.touching_ms)),
                        format(percentile_99(record.touching_ms)), format(mean(record.step_ms)),
                        format(percentile_99(record.step_ms)), format(paper),
                        format(100 * static_cast<double>(record.skipped) / static_cast<double>(record.pairs), 5),
                        std::to_string(record.apart), format(record.deepest)});
  table.write_csv(options.out / "physics.csv", options.machine);
  std::printf("%s\n", Table{table.columns, {table.rows.back()}}.markdown().c_str());
  std::fflush(stdout);
}

btTransform at(double x, double y, double z, const btQuaternion& turn = btQuaternion::getIdentity()) {
  return btTransform(turn, btVector3(btScalar(x), btScalar(y), btScalar(z)));
}

/// Letters of height 1.4 in a row, the bunny flies into the first.
void dominoes(const Options& options, Table& table) {
  std::deque<Model> models;  // bodies point to them
  World world;
  double x = 0;
  for (const TriangleMesh& letter : letters(1.4)) {
    models.emplace_back(letter);
    world.add(models.back(), at(x, 0, 0.7));
    x += 0.7;
  }
  models.emplace_back(small_bunny(1000));
  world.add(models.back(), at(-1.6, 0, 1.2)).setLinearVelocity(btVector3(6, 0, 0));
  run_scene("letters", world, options.quick ? 90 : 300, 75, 0.97, {4, -9, 4}, {3.6, 0, 0.3}, options, table);
}

void falling_bunnies(const Options& options, Table& table) {
  Model bunny(small_bunny(1000));
  World world;
  for (const auto& [nx, ny] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
    world.add_plane(btVector3(btScalar(nx), btScalar(ny), 0), -2.1);
  std::mt19937 engine(1);
  const auto uniform = [&] { return static_cast<double>(engine()) / 4294967296.0; };
  for (int i = 0; i < 50; ++i) {
    const btQuaternion turn(btVector3(btScalar(uniform() - 0.5), btScalar(uniform() - 0.5), btScalar(uniform() - 0.5)),
                            btScalar(6 * uniform()));
    world.add(bunny, at(-1.3 + 1.3 * (i % 3), -1.3 + 1.3 * (i / 3 % 3), 1 + 1.3 * (i / 9), turn));
  }
  run_scene("bunnies", world, options.quick ? 60 : 300, 100, 3.88, {7, -7, 5}, {0, 0, 1.6}, options, table);
}

int run(const Options& options) {
  Table table{{"scene", "bodies", "steps", "touching pairs", "pair ms", "pair 99% ms", "step ms", "step 99% ms",
               "paper's ms", "pairs culled %", "boxes meet only", "deepest, lower [scene units]"},
              {}};
  if (options.wants("letters")) dominoes(options, table);
  if (options.wants("bunnies")) falling_bunnies(options, table);
  if (!options.found_any()) return 0;
  write_file(options.out / "physics.md", table.markdown());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return bench_main(argc, argv, "Penetration depth in the two scenes of the paper, simulated by Bullet.", run);
}
