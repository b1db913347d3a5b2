// WalkNet by onnxruntime's C# package (Microsoft.ML.OnnxRuntime), in Unity or anywhere else; int8 or portable file.
using System;
using System.Collections.Generic;
using System.Linq;
using Microsoft.ML.OnnxRuntime;
using Microsoft.ML.OnnxRuntime.Tensors;

namespace Motionrt
{
    public sealed class OnnxRuntimeWalkNet : IWalkNet, IDisposable
    {
        private readonly InferenceSession session;

        public OnnxRuntimeWalkNet(string file)
        {
            using (var options = new SessionOptions { IntraOpNumThreads = 1 })
                session = new InferenceSession(file, options);
        }

        public float[] Next(float[] frames, float speed)
        {
            var inputs = new List<NamedOnnxValue>
            {
                NamedOnnxValue.CreateFromTensor(
                    "frames", new DenseTensor<float>(frames, new[] { 1, Walker.History, Walker.Width })),
                NamedOnnxValue.CreateFromTensor("speed", new DenseTensor<float>(new[] { speed }, new[] { 1 })),
            };
            if (session.InputMetadata.ContainsKey("wish")) // newer files take wishes beside the goal; zeros are none
                inputs.Add(NamedOnnxValue.CreateFromTensor("wish", new DenseTensor<float>(new float[8], new[] { 1, 8 })));
            using (var found = session.Run(inputs, new[] { "next" })) return found.First().AsTensor<float>().ToArray();
        }

        public void Dispose()
        {
            session.Dispose();
        }
    }
}
