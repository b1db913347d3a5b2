// WalkNet by Unity's inference engine (com.unity.ai.inference), and a character that it moves.
// Put walknet.portable.onnx and this folder into Assets; see docs/engines.md.
using System;
using Unity.InferenceEngine;
using UnityEngine;

namespace Motionrt
{
    public sealed class UnityWalkNet : IWalkNet, IDisposable
    {
        private readonly Worker worker;
        private readonly bool wishes; // newer files take wishes beside the goal; zeros are none

        public UnityWalkNet(ModelAsset asset)
        {
            Model model = ModelLoader.Load(asset);
            wishes = model.inputs.Exists(input => input.name == "wish");
            worker = new Worker(model, BackendType.CPU);
        }

        public float[] Next(float[] frames, float speed)
        {
            using (var seen = new Tensor<float>(new TensorShape(1, Walker.History, Walker.Width), frames))
            using (var wanted = new Tensor<float>(new TensorShape(1), new[] { speed }))
            using (var none = new Tensor<float>(new TensorShape(1, 8), new float[8]))
            {
                worker.SetInput("frames", seen);
                worker.SetInput("speed", wanted);
                if (wishes) worker.SetInput("wish", none);
                worker.Schedule();
                return (worker.PeekOutput("next") as Tensor<float>).DownloadToArray();
            }
        }

        public void Dispose()
        {
            worker.Dispose();
        }
    }

    /// <summary>Walks to a target at 30 frames a second; `joints` are the 24 of smpl24, in its order.</summary>
    public sealed class WalkingCharacter : MonoBehaviour
    {
        public ModelAsset model;
        public TextAsset history; // walk_history.bytes: 30 x 219 float32 of the test vectors, without NumPy's header
        public Transform[] joints;
        public Transform target;
        public float speed = 1.2f;

        private UnityWalkNet network;
        private Walker walker;

        private void Start()
        {
            var frames = new float[Walker.History * Walker.Width];
            Buffer.BlockCopy(history.bytes, 0, frames, 0, 4 * frames.Length);
            network = new UnityWalkNet(model);
            walker = new Walker(network, frames);
            Time.fixedDeltaTime = 1f / 30;
        }

        private void FixedUpdate()
        {
            Vector3 there = target.position;
            double heading = target.eulerAngles.y * Math.PI / 180;
            Pose(walker.Step(new Goal(-there.x, there.z, -heading), speed));
        }

        // Unity's axes are left-handed: x is mirrored.
        private void Pose(double[] frame)
        {
            for (int joint = 0; joint < Walker.Joints; joint++)
            {
                int at = 9 * joint;
                var forward = new Vector3(-(float)frame[at + 2], (float)frame[at + 5], (float)frame[at + 8]);
                var up = new Vector3(-(float)frame[at + 1], (float)frame[at + 4], (float)frame[at + 7]);
                joints[joint].localRotation = Quaternion.LookRotation(forward, up);
            }
            joints[0].localPosition = new Vector3(
                -(float)frame[Walker.Root], (float)frame[Walker.Root + 1], (float)frame[Walker.Root + 2]);
        }

        private void OnDestroy()
        {
            if (network != null) network.Dispose();
        }
    }
}
