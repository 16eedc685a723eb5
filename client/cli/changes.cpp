#include "client/cli/changes.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <utility>

#include "client/cli/scene_text.h"

namespace haptic::cli {
namespace {

using Numbers = std::vector<double>;

v1::Vector3 vector(const Numbers& numbers, std::size_t first = 0) {
  v1::Vector3 v;
  v.set_x(numbers.at(first));
  v.set_y(numbers.at(first + 1));
  v.set_z(numbers.at(first + 2));
  return v;
}

// inf and nan are numbers for the parser of arguments
std::string check_finite(const std::string& text) {
  double number = 0.0;
  const bool good = read_number(text, number) && std::isfinite(number);
  return good ? "" : "'" + text + "' is no finite number";
}

Option add_finite(CLI::App& verb, const std::string& name, const std::string& type, const std::string& help,
                  const std::function<void(double)>& take) {
  return add_number(verb, name, help, take).check(check_finite).type(type);
}

Option add_finite(CLI::App& verb, const std::string& name, int count, const std::string& type,
                  const std::string& help, const std::function<void(const Numbers&)>& take) {
  return add_numbers(verb, name, help, take).values(count).check(check_finite).type(type);
}

// the names of the fields that are there; of a sub-message that stays, those within
std::vector<std::string> fields_of(const google::protobuf::Message& message, const std::string& prefix) {
  std::vector<const google::protobuf::FieldDescriptor*> present;
  message.GetReflection()->ListFields(message, &present);
  std::vector<std::string> fields;
  for (const auto* field : present) {
    const std::string name = prefix + field->name();
    const bool inner = name == "dynamic" || name == "pose";
    const std::vector<std::string> within =
        inner ? fields_of(message.GetReflection()->GetMessage(message, field), name + ".")
              : std::vector<std::string>{};
    if (within.empty()) {
      fields.push_back(name);
    }
    fields.insert(fields.end(), within.begin(), within.end());
  }
  return fields;
}

// what the schema says and no option does: as text, or in a file
template <typename Message>
void add_message_options(CLI::App& verb, Changes<Message>& changes) {
  const auto take = [&changes](const std::string& option, const std::string& text) {
    Message message;
    if (const std::string mistake = parse_text(text, message); !mistake.empty()) {
      refuse(option, mistake);
    }
    for (const std::string& field : fields_of(message, "")) {
      if (field != "name") {
        changes.fields.push_back(field);
      }
    }
    changes.steps.push_back([message](Message& target) { target.MergeFrom(message); });
  };
  const Option text = add_text(verb, "--message", "protobuf text of the schema's " + Message().GetTypeName(),
                               [take](const std::string& value) { take("--message", value); })
                          .type("TEXT");
  add_text(verb, "--file", "the same in a file",
           [take](const std::string& path) {
             std::ifstream file(path, std::ios::binary);
             if (!file) {
               refuse("--file", "cannot read " + path);
             }
             take("--file " + path, {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()});
           })
      .type("FILE")
      .excludes(text);
}

// the name may also stand in --message
template <typename Message>
void add_name(CLI::App& verb, Changes<Message>& changes, const std::string& type, Editing editing) {
  add_text(verb, "name", "its name in the scene", [&changes](const std::string& name) {
    changes.steps.push_back([name](Message& m) { m.set_name(name); });
  }).type(editing == Editing::kSet ? type : "NAME");
  when_read(verb, [&changes, editing] {
    if (changes.applied_to({}).name().empty()) {
      refuse_without("name");
    }
    if (editing == Editing::kSet && changes.fields.empty()) {
      refuse("set", "nothing to set is told");
    }
  });
}

void exclude_each_other(const std::vector<Option>& options) {
  for (std::size_t one = 0; one < options.size(); ++one) {
    for (std::size_t other = 0; other < options.size(); ++other) {
      if (one != other) {
        options[one].excludes(options[other]);
      }
    }
  }
}

void add_shape_options(CLI::App& verb, Changes<v1::Object>& changes) {
  using v1::Object;
  const auto shape = [&changes](std::function<void(Object&)> step) { changes.add("shape", std::move(step)); };
  const Option box =
      add_finite(verb, "--box", 3, "X Y Z", "a box of this size, m", [shape](const Numbers& size) {
        shape([size](Object& o) { *o.mutable_shape()->mutable_box()->mutable_size() = vector(size); });
      });
  const Option sphere =
      add_finite(verb, "--sphere", "RADIUS", "a sphere of triangles, m", [shape](double radius) {
        shape([radius](Object& o) {
          o.mutable_shape()->mutable_icosphere()->set_radius(radius);
          o.mutable_shape()->mutable_icosphere()->set_subdivisions(3);
        });
      });
  add_count(verb, "--subdivisions", "of the sphere; default 3: 1280 triangles",
            [shape](std::uint32_t n) {
              shape([n](Object& o) { o.mutable_shape()->mutable_icosphere()->set_subdivisions(n); });
            })
      .type("N")
      .needs(sphere);
  const Option cylinder = add_finite(verb, "--cylinder", 2, "RADIUS HEIGHT", "a cylinder along z, m",
                                     [shape](const Numbers& size) {
                                       shape([size](Object& o) {
                                         v1::Shape::Cylinder& made = *o.mutable_shape()->mutable_cylinder();
                                         made.set_radius(size.at(0));
                                         made.set_height(size.at(1));
                                         made.set_segments(32);
                                       });
                                     });
  add_count(verb, "--segments", "of the cylinder; default 32",
            [shape](std::uint32_t n) {
              shape([n](Object& o) { o.mutable_shape()->mutable_cylinder()->set_segments(n); });
            })
      .type("N")
      .needs(cylinder);
  exclude_each_other({box, sphere, cylinder});
}

void add_dynamic_options(CLI::App& verb, Changes<v1::Object>& changes, Editing editing) {
  using v1::Object;
  const Option dynamic =
      add_flag(verb, "--dynamic", "it moves; otherwise it is fixed in the world",
               [&changes] { changes.add("dynamic", [](Object& o) { o.mutable_dynamic(); }); });
  if (editing == Editing::kSet) {
    add_flag(verb, "--fixed", "it is fixed in the world", [&changes] {
      changes.add("dynamic", [](Object& o) { o.clear_dynamic(); });
    }).excludes(dynamic);
  }
  const auto number = [&](const std::string& option, const std::string& type, const std::string& field,
                          const std::string& help, void (Object::Dynamic::*set)(double)) {
    add_finite(verb, option, type, help, [&changes, field, set](double value) {
      changes.add("dynamic." + field, [set, value](Object& o) { (o.mutable_dynamic()->*set)(value); });
    });
  };
  number("--linear-viscosity", "NS/M", "linear_viscosity", "N s/m; makes it dynamic",
         &Object::Dynamic::set_linear_viscosity);
  number("--angular-viscosity", "NMS/RAD", "angular_viscosity", "N m s/rad; makes it dynamic",
         &Object::Dynamic::set_angular_viscosity);
  number("--release-after", "SECONDS", "release_after", "fixed for so long first; makes it dynamic",
         &Object::Dynamic::set_release_after);
}

}  // namespace

void add_pose_options(CLI::App& verb, const PoseEditor& edit) {
  add_finite(verb, "--at", 3, "X Y Z", "where its origin is, m", [edit](const Numbers& at) {
    edit([at](v1::Pose& pose) { *pose.mutable_position() = vector(at); });
  });
  add_finite(verb, "--turn", 4, "W X Y Z", "how it is turned: a quaternion", [edit](const Numbers& turn) {
    edit([turn](v1::Pose& pose) {
      pose.mutable_orientation()->set_w(turn.at(0));
      pose.mutable_orientation()->set_x(turn.at(1));
      pose.mutable_orientation()->set_y(turn.at(2));
      pose.mutable_orientation()->set_z(turn.at(3));
    });
  });
}

void add_object_options(CLI::App& verb, Changes<v1::Object>& changes, Editing editing) {
  using v1::Object;
  add_message_options(verb, changes);
  add_name(verb, changes, "OBJECT", editing);
  add_shape_options(verb, changes);
  add_text(verb, "--inside", "what it is made of", [&changes](const std::string& name) {
    changes.add("inside", [name](Object& o) { o.set_inside(name); });
  }).type("MATERIAL");
  add_text(verb, "--outside", "of the layer of cells around it", [&changes](const std::string& name) {
    changes.add("outside", [name](Object& o) { o.set_outside(name); });
  }).type("MATERIAL");
  add_finite(verb, "--air-margin", "METRES", "how thick that layer is", [&changes](double margin) {
    changes.add("air_margin", [margin](Object& o) { o.set_air_margin(margin); });
  });
  if (editing == Editing::kAdd) {
    add_pose_options(verb, [&changes](const PoseChange& change) {
      changes.add("pose", [change](Object& o) { change(*o.mutable_pose()); });
    });
  }
  add_dynamic_options(verb, changes, editing);
}

void add_material_options(CLI::App& verb, Changes<v1::Material>& changes, Editing editing) {
  using v1::Material;
  add_message_options(verb, changes);
  add_name(verb, changes, "MATERIAL", editing);
  add_finite(verb, "--density", "KG/M^3", "counts for the mass of dynamic objects",
             [&changes](double density) {
               changes.add("density", [density](Material& m) { m.set_density(density); });
             });
  const Option free = add_flag(verb, "--free", "no resistance",
                               [&changes] { changes.add("free", [](Material& m) { m.mutable_free(); }); });
  const Option rigid = add_finite(verb, "--rigid", 2, "MU_S MU_K", "never entered; friction of its surface",
                                  [&changes](const Numbers& mu) {
                                    changes.add("rigid", [mu](Material& m) {
                                      m.mutable_rigid()->set_static_friction(mu.at(0));
                                      m.mutable_rigid()->set_kinetic_friction(mu.at(1));
                                    });
                                  });
  const Option yielding =
      add_finite(verb, "--yielding", "FORCE", "entered by more than this force, N", [&changes](double force) {
        changes.add("yielding", [force](Material& m) { m.mutable_yielding()->set_force(force); });
      });
  add_finite(verb, "--drag", "NS/M", "of what yields, N s/m", [&changes](double drag) {
    changes.add("yielding", [drag](Material& m) { m.mutable_yielding()->set_drag(drag); });
  }).needs(yielding);
  add_finite(verb, "--friction", 2, "MU_S MU_K", "of the surface of what yields",
             [&changes](const Numbers& mu) {
               changes.add("yielding", [mu](Material& m) {
                 m.mutable_yielding()->set_static_friction(mu.at(0));
                 m.mutable_yielding()->set_kinetic_friction(mu.at(1));
               });
             })
      .needs(yielding);
  const Option viscous = add_finite(
      verb, "--viscous", "NS/M", "resists in proportion to velocity, N s/m", [&changes](double drag) {
        changes.add("viscous", [drag](Material& m) { m.mutable_viscous()->set_drag(drag); });
      });
  exclude_each_other({free, rigid, yielding, viscous});
}

void add_finger_options(CLI::App& verb, Changes<v1::Finger>& changes, Editing editing) {
  using v1::Finger;
  add_message_options(verb, changes);
  add_name(verb, changes, "FINGER", editing);
  add_text(verb, "--device", "what it rides on", [&changes](const std::string& name) {
    changes.add("device", [name](Finger& f) { f.set_device(name); });
  }).type("DEVICE");
  add_finite(verb, "--stiffness", "N/M", "of each HIP", [&changes](double stiffness) {
    changes.add("stiffness", [stiffness](Finger& f) { f.set_stiffness(stiffness); });
  });
  const Option point = add_flag(verb, "--point", "one HIP at the device's origin",
                                [&changes] { changes.add("point", [](Finger& f) { f.mutable_point(); }); });
  const Option line = add_finite(verb, "--line", 6, "X Y Z X Y Z", "HIPs from here to there, m, device frame",
                                 [&changes](const Numbers& ends) {
                                   changes.add("line", [ends](Finger& f) {
                                     *f.mutable_line()->mutable_start() = vector(ends);
                                     *f.mutable_line()->mutable_end() = vector(ends, 3);
                                   });
                                 });
  const Option tip = add_finite(verb, "--fingertip", 2, "RADIUS ANGLE",
                                "a spherical cap: m, half angle in rad", [&changes](const Numbers& cap) {
                                  changes.add("fingertip", [cap](Finger& f) {
                                    f.mutable_fingertip()->set_radius(cap.at(0));
                                    f.mutable_fingertip()->set_cap_angle(cap.at(1));
                                  });
                                });
  add_finite(verb, "--direction", 3, "X Y Z", "of the cap's pole, device frame",
             [&changes](const Numbers& pole) {
               changes.add("fingertip",
                           [pole](Finger& f) { *f.mutable_fingertip()->mutable_direction() = vector(pole); });
             })
      .needs(tip);
  const Option hips_option =
      add_count(verb, "--hips", "how many on the line or the fingertip", [&changes](std::uint32_t hips) {
        changes.add("hips", [hips](Finger& f) {
          if (f.has_line()) {
            f.mutable_line()->set_hips(hips);
          } else {
            f.mutable_fingertip()->set_hips(hips);
          }
        });
      }).type("N");
  hips_option.excludes(point);
  exclude_each_other({point, line, tip});
}

}  // namespace haptic::cli
