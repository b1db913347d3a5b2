extends SceneTree

# Where the bones of an imported motion are at given seconds, as JSON: godot3-server -s joints.gd res://walk.glb 0 1.5
func _init():
	var given = OS.get_cmdline_args()
	given = Array(given).slice(Array(given).find("--") + 1, len(given) - 1)
	var scene = load(given[0]).instance()
	get_root().add_child(scene)
	var skeleton = _first(scene, "Skeleton")
	var player = _first(scene, "AnimationPlayer")
	var animation = player.get_animation_list()[0]
	var found = []
	player.play(animation)
	for text in given.slice(1, len(given) - 1):
		player.seek(float(text), true)
		var places = {}
		for bone in skeleton.get_bone_count():
			var at = (skeleton.global_transform * skeleton.get_bone_global_pose(bone)).origin
			places[skeleton.get_bone_name(bone)] = [at.x, at.y, at.z]
		found.append(places)
	print("joints ", to_json({"seconds": player.get_animation(animation).length, "joints": found}))
	quit()

func _first(node, kind):
	if node.get_class() == kind:
		return node
	for child in node.get_children():
		var found = _first(child, kind)
		if found:
			return found
	return null
